#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "platform/description.h"

namespace cgsr {

/// Writes an output as one line for people: `x 1.25 m, found yes, state lit`. Numbers have their decimals, a list is its count; what is
/// not there is left out.
class TextReader {
 public:
  static constexpr bool kOfType = false;

  explicit TextReader(std::string& text) : text_(text) {}

  void field(const Field& field);
  void begin_section(std::string_view, std::string_view, bool, bool) {}
  void end_section() {}
  void begin_list(std::string_view name, std::string_view meaning, std::size_t count);
  void end_list() { --lists_; }
  void begin_element() {}
  void end_element() {}

 private:
  void begin(std::string_view name);

  std::string& text_;
  bool first_ = true;
  int lists_ = 0;  // open around us: an element's fields are not written
};

/// Appends an output's fields, joined by commas.
template <class Output>
void append_text(std::string& text, const Output& output) {
  TextReader reader(text);
  read_fields(output, reader);
}

}  // namespace cgsr
