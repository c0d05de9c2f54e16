#pragma once

#include <string_view>
#include <vector>

namespace cgsr::config {

/// \return the name that a key of earlier versions has now, where the section knows that name; else empty. `known`: the keys of the section.
std::string_view renamed(std::string_view key, const std::vector<std::string_view>& known);

}  // namespace cgsr::config
