#pragma once

#include <string>
#include <vector>

namespace cgsr::lab {

/// The cells of a row of a CSV that the program wrote. A comma within quotes belongs to its cell; the last cell is empty where the row ends with a comma.
inline std::vector<std::string> csv_cells(const std::string& row) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : row) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c != '"') {
      cells.back() += c;
    }
  }
  return cells;
}

}  // namespace cgsr::lab
