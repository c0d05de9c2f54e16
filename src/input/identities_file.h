#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/person/identities.h"
#include "platform/error.h"

namespace cgsr::app {

/// Version that save_identities writes, and the only one that load_identities reads: views of another cannot be compared with a face as it is described now.
inline constexpr int kIdentitiesVersion = 3;

/// Writes the identities: CBOR {format, version, sha256, payload}, the payload again CBOR; readable by the owner alone (mode 0600). The file appears
/// whole or not at all: it is written beside its place, synchronised and renamed; of a symbolic link what it points to is written. A name that name_problem() speaks
/// against is refused.
Result<void> save_identities(const person::Identities& identities, const std::filesystem::path& path);

/// \return the identities; none where there is no such file; or what is wrong with it: not such a file, of another version, damaged.
Result<person::Identities> load_identities(const std::filesystem::path& path);

/// What is wrong with a name that somebody is to be enrolled under: it is empty, too long, or has control characters. \return nothing: it can be kept.
std::optional<std::string> name_problem(std::string_view name);

/// An identities file that is about to be changed. Two that change files of one folder wait for each other, so no person and no number is lost between reading
/// and writing. A damaged file counts as empty and is kept aside when the new one is written, under the name FILE.damaged-N and readable by its owner alone;
/// a file that is none of this program's is refused and stays where it is.
class IdentitiesEdit {
 public:
  /// \return what is wrong with the file or its folder, or that somebody else has been changing it for ten seconds.
  static Result<IdentitiesEdit> open(const std::filesystem::path& path);

  [[nodiscard]] person::Identities& identities() { return identities_; }
  /// Writes them, as save_identities(). \return where a damaged file was put, and why; empty: it was sound.
  Result<std::string> save();

 private:
  class FolderLock;
  IdentitiesEdit(std::filesystem::path path, person::Identities identities, std::string damage,
                 std::shared_ptr<const FolderLock> lock);

  std::filesystem::path path_;
  person::Identities identities_;
  std::string damage_;
  std::shared_ptr<const FolderLock> lock_;
};

/// \return the damaged identities files that were kept aside: they may hold people who were forgotten since.
std::vector<std::filesystem::path> kept_aside(const std::filesystem::path& path);

}  // namespace cgsr::app
