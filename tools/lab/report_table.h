#pragma once

#include <string>
#include <vector>

#include "tools/lab/report.h"

namespace cgsr::lab {

/// The rows of a report laid out for eyes: what was measured downwards, the quantities across.
struct Table {
  struct Line {
    std::string name;
    std::vector<const Row*> cells;  ///< one per heading; nullptr: not measured
  };
  std::vector<std::string> headings;
  std::vector<Line> lines;
};

/// \param report  outlives the table.
Table pivot(const Report& report);

/// \return a figure with three to four digits that matter.
std::string in_figures(double value);

/// \return "at most 4".
std::string required_words(const Requirement& requirement);

/// \return value, interval, the dissertation's value, what is required and whether it is met, of one cell.
std::string in_words(const Row* row);

}  // namespace cgsr::lab
