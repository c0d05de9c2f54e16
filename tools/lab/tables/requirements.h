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
};

/// \return all of them, table by table.
std::span<const NamedRequirement> requirements();

/// \return those of one table.
std::vector<NamedRequirement> requirements_of(std::string_view table);

}  // namespace cgsr::lab
