#include "platform/description/markdown.h"

#include <iterator>

#include <fmt/format.h>

namespace cgsr {
namespace {

std::string type_of(const Field& field) {
  switch (field.kind) {
    case Field::Kind::kNumber:
      return "number";
    case Field::Kind::kInteger:
      return "integer";
    case Field::Kind::kFlag:
      return "flag";
    case Field::Kind::kText:
      return "text";
    case Field::Kind::kChoice:
      break;
  }
  std::string words;
  for (int i = 0; i < field.choices; ++i) {
    if (i > 0) words += ", ";
    words += field.choice_at(i);
  }
  return words;
}

}  // namespace

void MarkdownReader::field(const Field& field) {
  row(field.name, type_of(field), field.optional, field.unit, field.meaning);
}

void MarkdownReader::begin_section(std::string_view name, std::string_view meaning, bool optional, bool /*present*/) {
  row(name, "section", optional, "", meaning);
  enter(name, ".");
}

void MarkdownReader::end_section() {
  path_.pop_back();
  const std::size_t dot = path_.rfind('.');
  path_.resize(dot == std::string::npos ? 0 : dot + 1);
}

void MarkdownReader::begin_list(std::string_view name, std::string_view meaning, std::size_t /*count*/) {
  row(name, "list", false, "", meaning);
  enter(name, "[].");
}

void MarkdownReader::row(std::string_view name, std::string_view type, bool optional, std::string_view unit,
                         std::string_view meaning) {
  fmt::format_to(std::back_inserter(rows_), "| `{}{}` | {}{} | {} | {} |\n", path_, name, type,
                 optional ? ", optional" : "", unit, meaning);
}

void MarkdownReader::enter(std::string_view name, std::string_view mark) {
  path_ += name;
  path_ += mark;
}

}  // namespace cgsr
