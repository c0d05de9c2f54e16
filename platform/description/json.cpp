#include "platform/description/json.h"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace cgsr {
namespace {

const char* type_of(Field::Kind kind) {
  switch (kind) {
    case Field::Kind::kNumber:
      return "number";
    case Field::Kind::kInteger:
      return "integer";
    case Field::Kind::kFlag:
      return "boolean";
    case Field::Kind::kChoice:
    case Field::Kind::kText:
      return "string";
  }
  return "string";
}

}  // namespace

void append_json_string(std::string& json, std::string_view text) {
  const auto plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
  if (std::all_of(text.begin(), text.end(), plain)) {
    json += '"';
    json += text;
    json += '"';
    return;
  }
  json += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonReader::separate() {
  const char last = json_.back();
  if (last != '{' && last != '[') json_ += ',';
}

void JsonReader::key(std::string_view name) {
  separate();
  append_json_string(json_, name);
  json_ += ':';
}

void JsonReader::field(const Field& field) {
  if (absent_ > 0 || !field.present) return;
  key(field.name);
  switch (field.kind) {
    case Field::Kind::kNumber:
      fmt::format_to(std::back_inserter(json_), "{}", field.number);
      return;
    case Field::Kind::kInteger:
      fmt::format_to(std::back_inserter(json_), "{}", field.integer);
      return;
    case Field::Kind::kFlag:
      json_ += field.integer != 0 ? "true" : "false";
      return;
    case Field::Kind::kChoice:
    case Field::Kind::kText:
      append_json_string(json_, field.text);
      return;
  }
}

void JsonReader::begin_section(std::string_view name, std::string_view /*meaning*/, bool /*optional*/, bool present) {
  if (!present) {
    ++absent_;
    return;
  }
  key(name);
  json_ += '{';
}

void JsonReader::end_section() {
  if (absent_ > 0) {
    --absent_;
  } else {
    json_ += '}';
  }
}

void JsonReader::begin_list(std::string_view name, std::string_view /*meaning*/, std::size_t /*count*/) {
  if (absent_ > 0) return;
  key(name);
  json_ += '[';
}

void JsonReader::end_list() {
  if (absent_ == 0) json_ += ']';
}

void JsonReader::begin_element() {
  separate();
  json_ += '{';
}

void JsonReader::end_element() {
  json_ += '}';
}

void JsonSchemaReader::begin(std::string_view title, std::string_view meaning) {
  schema_ += R"({"$schema":"https://json-schema.org/draft/2020-12/schema","title":)";
  append_json_string(schema_, title);
  schema_ += R"(,"description":)";
  append_json_string(schema_, meaning);
  schema_ += ',';
  open_object();
}

void JsonSchemaReader::end() {
  close_object();
  schema_ += '}';
}

void JsonSchemaReader::field(const Field& field) {
  key(field.name, !field.optional);
  schema_ += R"({"type":")";
  schema_ += type_of(field.kind);
  schema_ += R"(","description":)";
  append_json_string(
      schema_, field.unit.empty() ? std::string(field.meaning) : fmt::format("{} [{}]", field.meaning, field.unit));
  if (!field.unit.empty()) {
    schema_ += R"(,"unit":)";
    append_json_string(schema_, field.unit);
  }
  for (int i = 0; i < field.choices; ++i) {
    schema_ += i == 0 ? R"(,"enum":[)" : ",";
    append_json_string(schema_, field.choice_at(i));
  }
  schema_ += field.choices > 0 ? "]}" : "}";
}

void JsonSchemaReader::begin_section(std::string_view name, std::string_view meaning, bool optional, bool /*present*/) {
  key(name, !optional);
  schema_ += R"({"description":)";
  append_json_string(schema_, meaning);
  schema_ += ',';
  open_object();
}

void JsonSchemaReader::end_section() {
  close_object();
  schema_ += '}';
}

void JsonSchemaReader::begin_list(std::string_view name, std::string_view meaning, std::size_t /*count*/) {
  key(name, true);
  schema_ += R"({"type":"array","description":)";
  append_json_string(schema_, meaning);
  schema_ += R"(,"items":{)";
  open_object();
}

void JsonSchemaReader::end_element() {
  close_object();
  schema_ += "}}";
}

void JsonSchemaReader::open_object() {
  schema_ += R"("type":"object","properties":{)";
  required_.emplace_back();
}

void JsonSchemaReader::close_object() {
  schema_ += R"(},"required":[)";
  schema_ += required_.back();
  schema_ += ']';
  required_.pop_back();
}

void JsonSchemaReader::key(std::string_view name, bool required) {
  if (schema_.back() != '{') schema_ += ',';
  append_json_string(schema_, name);
  schema_ += ':';
  if (!required) return;
  std::string& names = required_.back();
  if (!names.empty()) names += ',';
  append_json_string(names, name);
}

}  // namespace cgsr
