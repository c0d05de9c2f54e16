#include "platform/description/csv.h"

#include <iterator>

#include <fmt/format.h>

namespace cgsr {
namespace {

void append_text(std::string& row, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) {
    row += text;
    return;
  }
  row += '"';
  for (const char c : text) {
    if (c == '"') row += '"';
    row += c;
  }
  row += '"';
}

}  // namespace

void CsvHeaderReader::field(const Field& field) {
  if (lists_ > 0) return;
  if (!header_.empty()) header_ += ',';
  header_ += prefix_;
  header_ += field.name;
}

void CsvHeaderReader::begin_section(std::string_view name, std::string_view /*meaning*/, bool /*optional*/,
                                    bool /*present*/) {
  prefix_ += name;
  prefix_ += '_';
  lengths_.push_back(name.size() + 1);
}

void CsvHeaderReader::end_section() {
  prefix_.resize(prefix_.size() - lengths_.back());
  lengths_.pop_back();
}

void CsvHeaderReader::begin_list(std::string_view name, std::string_view meaning, std::size_t /*count*/) {
  Field count;
  count.name = name;
  count.meaning = meaning;
  field(count);
  ++lists_;
}

void CsvRowReader::next_cell() {
  if (!first_) row_ += ',';
  first_ = false;
}

void CsvRowReader::field(const Field& field) {
  if (lists_ > 0) return;
  next_cell();
  if (!field.present) return;
  switch (field.kind) {
    case Field::Kind::kNumber:
      fmt::format_to(std::back_inserter(row_), "{:.{}f}", field.number, field.decimals);
      return;
    case Field::Kind::kInteger:
    case Field::Kind::kFlag:
      fmt::format_to(std::back_inserter(row_), "{}", field.integer);
      return;
    case Field::Kind::kChoice:
    case Field::Kind::kText:
      append_text(row_, field.text);
      return;
  }
}

void CsvRowReader::begin_list(std::string_view /*name*/, std::string_view /*meaning*/, std::size_t count) {
  if (lists_++ > 0) return;
  next_cell();
  fmt::format_to(std::back_inserter(row_), "{}", count);
}

}  // namespace cgsr
