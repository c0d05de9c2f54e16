#include "platform/config/reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/config/renamed.h"
#include "platform/config/spelling.h"
#include "platform/config/tree.h"

namespace cgsr::config {

namespace {

constexpr std::size_t kLongestEcho = 60;

std::string shortened(std::string ascii) {
  if (ascii.size() > kLongestEcho) ascii = ascii.substr(0, kLongestEcho) + "...";
  return ascii;
}

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

int line_of(const toml::node& node) {
  return static_cast<int>(node.source().begin.line);
}

/// The key as it may be printed: bare, or quoted and escaped.
std::string printable(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return shortened(bare ? std::string(key) : one_line(toml::value<std::string>(std::string(key))));
}

}  // namespace

struct Reader::State {
  struct Level {
    const toml::table* table;
    std::string prefix;  // "stage.track."
    std::vector<std::string_view> known;
  };
  struct Problem {
    int line;  // 0: none
    std::string text;
  };

  const Document& document;
  Missing missing;
  std::vector<Level> levels;
  std::vector<Problem> problems;

  Level& level() { return levels.back(); }
  void complain(int line, std::string text) { problems.push_back({line, std::move(text)}); }

  /// \return the value of a key, noting that the key is known; null when it is missing, which may be a problem.
  const toml::node* find(std::string_view name) {
    level().known.push_back(name);
    const toml::node* node = level().table->get(name);
    if (node == nullptr && missing == Missing::kIsAnError) {
      complain(line_of(*level().table), fmt::format("{}{} is missing", level().prefix, name));
    }
    return node;
  }

  void complain_of_type(std::string_view name, const toml::node& node, std::string_view wanted) {
    const bool scalar = !node.is_table() && !node.is_array();
    const std::string echo = scalar ? shortened(one_line(node)) + ", " : "";
    complain(line_of(node),
             fmt::format("{}{} is {}{}; {} is wanted", level().prefix, name, echo, kind_of(node), wanted));
  }

  template <class Number>
  void complain_of_range(std::string_view name, const toml::node& node, Number value, Range<Number> range,
                         std::string_view unit) {
    if (unit == "1") unit = "";  // a count, which nobody says "1" after
    complain(line_of(node), fmt::format("{}{} = {} is not in {}..{}{}{}", level().prefix, name, value, range.minimum,
                                        range.maximum, unit.empty() ? "" : " ", unit));
  }

  void complain_of_unknown_keys() {
    for (const auto& [key, node] : *level().table) {
      const auto& known = level().known;
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      const std::string_view now = renamed(key.str(), known);
      complain(line_of(node),
               fmt::format("{}{} is unknown{}", level().prefix, printable(key.str()),
                           now.empty() ? hint(key.str(), known) : fmt::format("; it is called {} now", now)));
    }
  }
};

Reader::Reader(const Document& document, Missing missing)
    : state_(std::make_unique<State>(State{document, missing, {{&document.tree().root, "", {}}}, {}})) {}

Reader::~Reader() = default;

void Reader::number(std::string_view name, int& value, Range<int> range, std::string_view unit, std::string_view) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  const auto read = node->value_exact<std::int64_t>();
  if (!read) return state_->complain_of_type(name, *node, "a whole number");
  if (*read < range.minimum || *read > range.maximum) {
    return state_->complain_of_range<std::int64_t>(name, *node, *read, {range.minimum, range.maximum}, unit);
  }
  value = static_cast<int>(*read);
}

void Reader::number(std::string_view name, double& value, Range<double> range, std::string_view unit,
                    std::string_view) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  const auto read = node->is_number() ? node->value<double>() : std::nullopt;
  if (!read) return state_->complain_of_type(name, *node, "a number");
  if (!std::isfinite(*read) || *read < range.minimum || *read > range.maximum) {
    return state_->complain_of_range(name, *node, *read, range, unit);
  }
  value = *read;
}

void Reader::flag(std::string_view name, bool& value, std::string_view) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  const auto read = node->value_exact<bool>();
  if (!read) return state_->complain_of_type(name, *node, "true or false");
  value = *read;
}

void Reader::text(std::string_view name, std::string& value, std::string_view) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  auto read = node->value_exact<std::string>();
  if (!read) return state_->complain_of_type(name, *node, "a text");
  value = std::move(*read);
}

std::optional<std::size_t> Reader::choose(std::string_view name, const std::vector<std::string_view>& words) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return std::nullopt;
  const auto word = node->value_exact<std::string_view>();
  if (!word) {
    state_->complain_of_type(name, *node, fmt::format("one of \"{}\"", fmt::join(words, "\", \"")));
    return std::nullopt;
  }
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());

  const std::string_view meant = nearest(*word, words);
  state_->complain(line_of(*node), fmt::format("{}{} = {} is not one of \"{}\"{}", state_->level().prefix, name,
                                               shortened(one_line(*node)), fmt::join(words, "\", \""),
                                               meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant)));
  return std::nullopt;
}

bool Reader::enter(std::string_view name) {
  State::Level& outer = state_->level();
  outer.known.push_back(name);
  const toml::node* node = outer.table->get(name);
  if (node == nullptr) {
    if (state_->missing == Missing::kIsAnError) {
      state_->complain(line_of(*outer.table), fmt::format("section [{}{}] is missing", outer.prefix, name));
    }
    return false;
  }
  const toml::table* table = node->as_table();
  if (table == nullptr) {
    state_->complain_of_type(name, *node, fmt::format("a section [{}{}]", outer.prefix, name));
    return false;
  }
  state_->levels.push_back({table, fmt::format("{}{}.", outer.prefix, name), {}});
  return true;
}

std::size_t Reader::list_length(std::string_view name) {
  State::Level& outer = state_->level();
  outer.known.push_back(name);
  const toml::node* node = outer.table->get(name);
  if (node == nullptr) return 0;
  if (!node->is_array())
    state_->complain_of_type(name, *node, fmt::format("a list of sections [[{}{}]]", outer.prefix, name));
  return node->is_array() ? node->as_array()->size() : 0;
}

bool Reader::enter_item(std::string_view name, std::size_t index) {
  State::Level& outer = state_->level();
  const toml::node& node = *outer.table->get(name)->as_array()->get(index);
  const std::string item = fmt::format("{}[{}]", name, index);
  if (!node.is_table()) {
    state_->complain_of_type(item, node, "a section");
    return false;
  }
  state_->levels.push_back({node.as_table(), fmt::format("{}{}.", outer.prefix, item), {}});
  return true;
}

void Reader::read_numbers(std::string_view name, double* values, std::size_t count, Range<double> range,
                          std::string_view unit) {
  const toml::node* node = state_->find(name);
  if (node == nullptr) return;
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) {
    return state_->complain_of_type(name, *node, fmt::format("a list of {} numbers", count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const toml::node& element = *array->get(i);
    const std::string item = fmt::format("{}[{}]", name, i);
    const auto read = element.is_number() ? element.value<double>() : std::nullopt;
    if (!read) {
      state_->complain_of_type(item, element, "a number");
    } else if (!std::isfinite(*read) || *read < range.minimum || *read > range.maximum) {
      state_->complain_of_range(item, element, *read, range, unit);
    } else {
      values[i] = *read;
    }
  }
}

void Reader::line(int& value) const {
  value = line_of(*state_->level().table);
}

void Reader::leave() {
  state_->complain_of_unknown_keys();
  state_->levels.pop_back();
}

void Reader::complain_of_section(const std::string& inconsistency) {
  if (inconsistency.empty()) return;
  const std::string& prefix = state_->level().prefix;
  const std::string where = prefix.empty() ? "" : fmt::format("[{}] ", prefix.substr(0, prefix.size() - 1));
  state_->complain(line_of(*state_->level().table), where + inconsistency);
}

std::size_t Reader::problem_count() const {
  return state_->problems.size();
}

Result<void> Reader::finish() {
  state_->complain_of_unknown_keys();
  auto& problems = state_->problems;
  if (problems.empty()) return {};
  // What has no line of its own (a section that is missing altogether) comes last.
  const auto order = [](const State::Problem& problem) {
    return problem.line > 0 ? problem.line : std::numeric_limits<int>::max();
  };
  std::stable_sort(problems.begin(), problems.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  std::string message;
  for (const auto& [line, text] : problems) {
    if (!message.empty()) message += '\n';
    message += line > 0 ? fmt::format("{}:{}: {}", state_->document.name(), line, text)
                        : fmt::format("{}: {}", state_->document.name(), text);
  }
  return fail(std::move(message));
}

}  // namespace cgsr::config
