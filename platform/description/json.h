#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "platform/description.h"

namespace cgsr {

/// Writes an output as one JSON object on one line. Numbers have as many digits as bring the same double back; flags are booleans, choices
/// their words, sections objects, lists arrays of objects. What is not there has no key.
class JsonReader {
 public:
  static constexpr bool kOfType = false;

  explicit JsonReader(std::string& json) : json_(json) {}

  void field(const Field& field);
  void begin_section(std::string_view name, std::string_view meaning, bool optional, bool present);
  void end_section();
  void begin_list(std::string_view name, std::string_view meaning, std::size_t count);
  void end_list();
  void begin_element();
  void end_element();

 private:
  void separate();
  void key(std::string_view name);

  std::string& json_;
  int absent_ = 0;  // sections that are not there, open around us
};

/// Writes the JSON schema (draft 2020-12) that JsonReader's objects obey: type and meaning of every field, its unit in the description
/// (`x_m: …, [m]`) and in the key `unit`, the words of a choice as `enum`. Required is what is always there.
class JsonSchemaReader {
 public:
  static constexpr bool kOfType = true;

  explicit JsonSchemaReader(std::string& schema) : schema_(schema) {}

  void begin(std::string_view title, std::string_view meaning);
  void end();

  void field(const Field& field);
  void begin_section(std::string_view name, std::string_view meaning, bool optional, bool present);
  void end_section();
  void begin_list(std::string_view name, std::string_view meaning, std::size_t count);
  void end_list() {}
  void begin_element() {}
  void end_element();

 private:
  void open_object();
  void close_object();
  void key(std::string_view name, bool required);

  std::string& schema_;
  std::vector<std::string> required_;  // by open object, JSON strings joined by commas
};

/// Appends `text` as a JSON string with its quotes. What is not UTF-8 becomes U+FFFD.
void append_json_string(std::string& json, std::string_view text);

/// Appends an output as a JSON object. Allocates where `json` has to grow, and for text.
template <class Output>
void append_json(std::string& json, const Output& output) {
  JsonReader reader(json);
  json += '{';
  read_fields(output, reader);
  json += '}';
}

/// \return the JSON schema of what append_json() writes for this type, without line feeds.
template <class Output>
std::string json_schema(std::string_view title, std::string_view meaning) {
  std::string schema;
  JsonSchemaReader reader(schema);
  reader.begin(title, meaning);
  read_fields_of<Output>(reader);
  reader.end();
  return schema;
}

}  // namespace cgsr
