#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace cgsr::config {

struct NewName {
  std::string_view name;    ///< relative to the section: "kind", or "base.rmp" for a section that moved into another.
  std::string_view remark;  ///< what else changed with it; may be empty.
};

/// \return the name that a key of earlier versions has now, where the section knows that name. `known`: the keys of the section.
std::optional<NewName> renamed(std::string_view key, const std::vector<std::string_view>& known);

}  // namespace cgsr::config
