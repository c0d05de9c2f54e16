#pragma once

#include <string>
#include <string_view>

namespace cgsr::lab {

/// \return a file of the source folder from which the lab was built, by its path from the root: the lab measures what is shipped there.
std::string source_path(std::string_view path);

}  // namespace cgsr::lab
