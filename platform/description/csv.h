#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "platform/description.h"

namespace cgsr {

/// Writes the names of the columns: a section's fields get its name and an underscore in front, a list is one column.
class CsvHeaderReader {
 public:
  static constexpr bool kOfType = true;

  /// \param prefix  in front of every name.
  CsvHeaderReader(std::string& header, std::string_view prefix) : header_(header), prefix_(prefix) {}

  void field(const Field& field);
  void begin_section(std::string_view name, std::string_view meaning, bool optional, bool present);
  void end_section();
  void begin_list(std::string_view name, std::string_view meaning, std::size_t count);
  void end_list() { --lists_; }
  void begin_element() {}
  void end_element() {}

 private:
  std::string& header_;
  std::string prefix_;
  std::vector<std::size_t> lengths_;  // of what each open section added to the prefix
  int lists_ = 0;                     // open around us: an element's fields have no columns
};

/// Writes the cells of one row: numbers with their decimals, flags as 0 and 1, choices as their words, a list as its count; what is not
/// there is empty. Text with a comma, a quote or a line feed is quoted (RFC 4180).
class CsvRowReader {
 public:
  static constexpr bool kOfType = false;

  explicit CsvRowReader(std::string& row) : row_(row) {}

  void field(const Field& field);
  void begin_section(std::string_view, std::string_view, bool, bool) {}
  void end_section() {}
  void begin_list(std::string_view name, std::string_view meaning, std::size_t count);
  void end_list() { --lists_; }
  void begin_element() {}
  void end_element() {}

 private:
  void next_cell();

  std::string& row_;
  bool first_ = true;
  int lists_ = 0;
};

/// \return the names of an output's columns, joined by commas.
template <class Output>
std::string csv_header(std::string_view prefix = "") {
  std::string header;
  CsvHeaderReader reader(header, prefix);
  read_fields_of<Output>(reader);
  return header;
}

/// Appends an output's cells, joined by commas: as many as csv_header() has names. Allocates only where `row` has to grow.
template <class Output>
void append_csv_row(std::string& row, const Output& output) {
  CsvRowReader reader(row);
  read_fields(output, reader);
}

}  // namespace cgsr
