#include "src/input/yaml_reader.h"

#include <charconv>
#include <cmath>
#include <set>
#include <system_error>

#include <fmt/format.h>

namespace cgsr::app {

Error YamlReader::wrong(const YAML::Node& at, const std::string& words) const {
  return {fmt::format("{}:{}: {}", name_, at.Mark().line + 1, words)};
}

Error YamlReader::missing(std::string_view key, std::string_view expected) const {
  return {fmt::format("{}: there is no '{}': expected {}", name_, key, expected)};
}

Result<void> YamlReader::refuse_doubled_keys() const {
  std::set<std::string> seen;
  for (const auto& entry : root_) {
    if (!entry.first.IsScalar()) return tl::unexpected(wrong(entry.first, "a key is no word"));
    if (!seen.insert(entry.first.Scalar()).second) {
      return tl::unexpected(wrong(entry.first, fmt::format("'{}' is there a second time", entry.first.Scalar())));
    }
  }
  return {};
}

Result<double> YamlReader::number(const YAML::Node& node, std::string_view key) const {
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  double value = 0.0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    return tl::unexpected(wrong(node, fmt::format("{} holds '{}': expected a finite number", key, shown(node))));
  }
  return value;
}

Result<double> YamlReader::number_at(std::string_view key, std::string_view expected) const {
  const YAML::Node node = root_[std::string(key)];
  if (!node) return tl::unexpected(missing(key, expected));
  return number(node, key);
}

Result<std::vector<double>> YamlReader::numbers(const YAML::Node& sequence, std::string_view key) const {
  std::vector<double> values;
  values.reserve(sequence.size());
  for (const YAML::Node& entry : sequence) {
    const auto value = number(entry, key);
    if (!value) return tl::unexpected(value.error());
    values.push_back(*value);
  }
  return values;
}

Result<std::vector<double>> YamlReader::matrix(std::string_view key, std::string_view expected) const {
  const YAML::Node node = root_[std::string(key)];
  if (!node) return tl::unexpected(missing(key, expected));
  if (!node.IsMap() || !node["rows"] || !node["cols"] || !node["data"] || !node["data"].IsSequence()) {
    return tl::unexpected(wrong(node, fmt::format("{} is not a matrix: expected rows, cols and data: [...]", key)));
  }
  const auto rows = number(node["rows"], fmt::format("{}.rows", key));
  if (!rows) return tl::unexpected(rows.error());
  const auto cols = number(node["cols"], fmt::format("{}.cols", key));
  if (!cols) return tl::unexpected(cols.error());
  auto values = numbers(node["data"], key);
  if (!values) return values;
  if (*rows * *cols != static_cast<double>(values->size())) {
    return tl::unexpected(wrong(node["data"], fmt::format("{} holds {} numbers: expected rows x cols = {} x {}", key,
                                                          values->size(), *rows, *cols)));
  }
  return values;
}

std::string YamlReader::shown(const YAML::Node& node) {
  if (!node.IsScalar()) return node.IsSequence() ? "[...]" : node.IsMap() ? "{...}" : "";
  return node.Scalar().substr(0, 60);
}

}  // namespace cgsr::app
