#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "tools/lab/report.h"

namespace cgsr::lab {

/// What one row of a table has to keep to.
struct NamedRequirement {
  std::string_view table;
  std::string_view row;
  std::string_view quantity;
  Requirement requirement;
  std::string_view unmet_because =
      {};  ///< why it is not met, as far as that is known; the page says it while it is not.
};

/// \return all of them, table by table.
std::span<const NamedRequirement> requirements();

/// \return why a requirement is not met; empty: not known, or there is no such requirement.
std::string_view unmet_because(std::string_view table, std::string_view row, std::string_view quantity);

/// \return those of one table.
std::vector<NamedRequirement> requirements_of(std::string_view table);

}  // namespace cgsr::lab
