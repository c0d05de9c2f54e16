#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "platform/error.h"

namespace cgsr::lab {

/// \return C++ without comments and with every run of blanks as one: what a compiler sees, about. Literals are kept as they are.
std::string without_comments(std::string_view cpp);

/// The hash of sources: names and contents of the C++ files (without_comments()) and TOML files in `paths`.
///
/// \param root  of the source tree.  \param paths  files, and folders with all that lies below, relative to it.
/// \return 64 hexadecimal digits; or which path is not there.
Result<std::string> sources_sha256(const std::filesystem::path& root, std::span<const std::string_view> paths);

/// \return the commit that is checked out, twelve digits, with "+changes" where a file of `paths` differs from it; "unknown" outside a repository.
std::string commit_of(const std::filesystem::path& root, std::span<const std::string_view> paths);

}  // namespace cgsr::lab
