#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "platform/description.h"

namespace cgsr {

/// Writes a row of a Markdown table for every field: path, type or words, unit, meaning.
class MarkdownReader {
 public:
  static constexpr bool kOfType = true;

  explicit MarkdownReader(std::string& rows) : rows_(rows) {}

  void field(const Field& field);
  void begin_section(std::string_view name, std::string_view meaning, bool optional, bool present);
  void end_section();
  void begin_list(std::string_view name, std::string_view meaning, std::size_t count);
  void end_list() { end_section(); }
  void begin_element() {}
  void end_element() {}

 private:
  void row(std::string_view name, std::string_view type, bool optional, std::string_view unit,
           std::string_view meaning);
  void enter(std::string_view name, std::string_view mark);

  std::string& rows_;
  std::string path_;  // "lamp.", "balls[]."
};

/// The head of the table.
inline constexpr std::string_view kMarkdownFieldsHead = "| field | type | unit | meaning |\n|---|---|---|---|\n";

/// \return a Markdown table of an output's fields.
template <class Output>
std::string markdown_fields() {
  std::string rows(kMarkdownFieldsHead);
  MarkdownReader reader(rows);
  read_fields_of<Output>(reader);
  return rows;
}

}  // namespace cgsr
