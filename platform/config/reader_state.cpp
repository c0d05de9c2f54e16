#include "platform/config/reader_state.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "platform/config/renamed.h"
#include "platform/config/spelling.h"

namespace cgsr::config {
namespace {

constexpr std::size_t kMaxEcho = 60;

std::string_view kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number with a point";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::table:
      return "a section";
    case toml::node_type::array:
      return "a list";
    default:
      return "a date or time";
  }
}

/// The key as it may be printed: bare, or quoted and escaped.
std::string printable(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return shortened(bare ? std::string(key) : one_line(toml::value<std::string>(std::string(key))));
}

}  // namespace

std::string shortened(std::string ascii) {
  if (ascii.size() > kMaxEcho) ascii = ascii.substr(0, kMaxEcho) + "...";
  return ascii;
}

Reader::State::State(Layers from) : layers(std::move(from)) {
  Level root;
  for (const Layers::Layer& layer : layers.all()) root.tables.push_back(&layer.document.tree().root);
  if (layers.may_extend()) root.known.emplace_back("extends");
  levels.push_back(std::move(root));
}

std::vector<Reader::State::Found> Reader::State::find(std::string_view name) {
  level().known.push_back(name);
  std::vector<Found> found;
  const auto& tables = level().tables;
  for (std::size_t layer = tables.size(); layer-- > 0;) {
    if (tables[layer] == nullptr) continue;
    if (const toml::node* node = tables[layer]->get(name)) found.push_back({layer, node});
  }
  return found;
}

void Reader::State::took(std::string_view name, const Found& found) {
  provenance.origins[fmt::format("{}{}", level().prefix, name)] = {document(found.layer).name(), line_of(*found.node)};
}

void Reader::State::complain(const Found& found, std::string text) {
  problems.push_back({found.layer, line_of(*found.node), std::move(text)});
}

void Reader::State::complain_of_level(std::string text) {
  const auto& tables = level().tables;
  const auto first =
      std::find_if(tables.begin(), tables.end(), [](const toml::table* table) { return table != nullptr; });
  complain({static_cast<std::size_t>(first - tables.begin()), *first}, std::move(text));
}

void Reader::State::complain_of_type(std::string_view name, const Found& found, std::string_view expected) {
  const toml::node& node = *found.node;
  const bool scalar = !node.is_table() && !node.is_array();
  const std::string echo = scalar ? shortened(one_line(node)) + ", " : "";
  complain(found, fmt::format("{}{} is {}{}; expected {}", level().prefix, name, echo, kind_of(node), expected));
}

void Reader::State::complain_of_unknown_keys() {
  const auto& [tables, prefix, known] = level();
  for (std::size_t layer = 0; layer < tables.size(); ++layer) {
    if (tables[layer] == nullptr) continue;
    for (const auto& [key, node] : *tables[layer]) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      const auto now = renamed(key.str(), known);
      const std::string advice =
          now ? fmt::format("; it is called {} now{}{}", now->name, now->remark.empty() ? "" : "; ", now->remark)
              : hint(key.str(), known);
      complain({layer, &node}, fmt::format("{}{} is unknown{}", prefix, printable(key.str()), advice));
    }
  }
}

Result<void> Reader::State::outcome() {
  if (problems.empty()) return {};
  std::stable_sort(problems.begin(), problems.end(), [](const Problem& a, const Problem& b) {
    return std::tie(a.layer, a.line) < std::tie(b.layer, b.line);
  });
  std::string message;
  for (const auto& [layer, line, text] : problems) {
    if (!message.empty()) message += '\n';
    message += fmt::format("{}:{}: {}", document(layer).name(), line, text);
  }
  return fail(std::move(message));
}

}  // namespace cgsr::config
