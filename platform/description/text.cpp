#include "platform/description/text.h"

#include <iterator>

#include <fmt/format.h>

namespace cgsr {

void TextReader::begin(std::string_view name) {
  if (!first_) text_ += ", ";
  first_ = false;
  text_ += name;
  text_ += ' ';
}

void TextReader::field(const Field& field) {
  if (lists_ > 0 || !field.present) return;
  begin(field.name);
  switch (field.kind) {
    case Field::Kind::kNumber:
      fmt::format_to(std::back_inserter(text_), "{:.{}f}", field.number, field.decimals);
      break;
    case Field::Kind::kInteger:
      text_ += fmt::to_string(field.integer);
      break;
    case Field::Kind::kFlag:
      text_ += field.integer != 0 ? "yes" : "no";
      break;
    case Field::Kind::kChoice:
    case Field::Kind::kText:
      text_ += field.text;
      break;
  }
  if (!field.unit.empty()) fmt::format_to(std::back_inserter(text_), " {}", field.unit);
}

void TextReader::begin_list(std::string_view name, std::string_view /*meaning*/, std::size_t count) {
  if (lists_++ > 0) return;
  begin(name);
  text_ += fmt::to_string(count);
}

}  // namespace cgsr
