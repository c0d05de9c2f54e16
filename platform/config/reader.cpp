#include "platform/config/reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/config/reader_state.h"
#include "platform/config/spelling.h"

namespace cgsr::config {
namespace {

/// \return whether a number may be used at all.
bool is_within(double value, Range<double> range) {
  return std::isfinite(value) && value >= range.minimum && value <= range.maximum;
}

}  // namespace

Reader::Reader(Layers layers) : state_(std::make_unique<State>(std::move(layers))) {}

Reader::~Reader() = default;

void Reader::number(std::string_view name, int& value, Range<int> range, std::string_view unit, std::string_view) {
  for (const State::Found& found : state_->find(name)) {
    const auto read = found.node->value_exact<std::int64_t>();
    if (!read) {
      state_->complain_of_type(name, found, "a whole number");
    } else if (*read < range.minimum || *read > range.maximum) {
      state_->complain_of_range<std::int64_t>(name, found, *read, {range.minimum, range.maximum}, unit);
    } else {
      value = static_cast<int>(*read);
      state_->took(name, found);
    }
  }
}

void Reader::number(std::string_view name, double& value, Range<double> range, std::string_view unit,
                    std::string_view) {
  for (const State::Found& found : state_->find(name)) {
    const auto read = found.node->is_number() ? found.node->value<double>() : std::nullopt;
    if (!read) {
      state_->complain_of_type(name, found, "a number");
    } else if (!is_within(*read, range)) {
      state_->complain_of_range(name, found, *read, range, unit);
    } else {
      value = *read;
      state_->took(name, found);
    }
  }
}

void Reader::flag(std::string_view name, bool& value, std::string_view) {
  for (const State::Found& found : state_->find(name)) {
    if (const auto read = found.node->value_exact<bool>()) {
      value = *read;
      state_->took(name, found);
    } else {
      state_->complain_of_type(name, found, "true or false");
    }
  }
}

void Reader::text(std::string_view name, std::string& value, std::string_view) {
  for (const State::Found& found : state_->find(name)) {
    if (auto read = found.node->value_exact<std::string>()) {
      value = std::move(*read);
      state_->took(name, found);
    } else {
      state_->complain_of_type(name, found, "a text");
    }
  }
}

void Reader::path(std::string_view name, std::string& value, std::string_view) {
  for (const State::Found& found : state_->find(name)) {
    const auto read = found.node->value_exact<std::string>();
    if (!read) {
      state_->complain_of_type(name, found, "a text");
      continue;
    }
    const Layers::Layer& layer = state_->layers.all()[found.layer];
    value = path_beside(layer.document.name(), *read).string();
    if (!read->empty()) state_->provenance.written_paths[value] = (layer.folder / *read).lexically_normal().string();
    state_->took(name, found);
  }
}

std::optional<std::size_t> Reader::choose(std::string_view name, const std::vector<std::string_view>& words) {
  std::optional<std::size_t> chosen;
  const std::string all = fmt::format("\"{}\"", fmt::join(words, "\", \""));
  for (const State::Found& found : state_->find(name)) {
    const auto word = found.node->value_exact<std::string_view>();
    if (!word) {
      state_->complain_of_type(name, found, "one of " + all);
      continue;
    }
    const auto at = std::find(words.begin(), words.end(), *word);
    if (at != words.end()) {
      chosen = static_cast<std::size_t>(at - words.begin());
      state_->took(name, found);
      continue;
    }
    const std::string_view meant = nearest(*word, words);
    state_->complain(found, fmt::format("{}{} = {} is not one of {}{}", state_->level().prefix, name,
                                        shortened(one_line(*found.node)), all,
                                        meant.empty() ? "" : fmt::format("; did you mean \"{}\"?", meant)));
  }
  return chosen;
}

bool Reader::enter(std::string_view name) {
  State::Level inner{{}, fmt::format("{}{}.", state_->level().prefix, name), {}};
  inner.tables.resize(state_->level().tables.size(), nullptr);
  bool any = false;
  for (const State::Found& found : state_->find(name)) {
    const toml::table* table = found.node->as_table();
    if (table == nullptr) {
      state_->complain_of_type(name, found, fmt::format("a section [{}{}]", state_->level().prefix, name));
      continue;
    }
    inner.tables[found.layer] = table;
    any = true;
  }
  if (any) state_->levels.push_back(std::move(inner));
  return any;
}

// The list of the layer that counts replaces those of the others.
std::size_t Reader::list_length(std::string_view name) {
  const auto found = state_->find(name);
  if (found.empty()) return 0;
  const toml::array* array = found.back().node->as_array();
  if (array != nullptr) return array->size();
  state_->complain_of_type(name, found.back(),
                           fmt::format("a list of sections [[{}{}]]", state_->level().prefix, name));
  return 0;
}

bool Reader::enter_item(std::string_view name, std::size_t index) {
  State::Level& outer = state_->level();
  std::size_t layer = 0;
  while (outer.tables[layer] == nullptr || outer.tables[layer]->get(name) == nullptr) ++layer;
  const toml::node& node = *outer.tables[layer]->get(name)->as_array()->get(index);
  const std::string item = fmt::format("{}[{}]", name, index);
  if (!node.is_table()) {
    state_->complain_of_type(item, {layer, &node}, "a section");
    return false;
  }
  State::Level inner{{}, fmt::format("{}{}.", outer.prefix, item), {}};
  inner.tables.resize(outer.tables.size(), nullptr);
  inner.tables[layer] = node.as_table();
  state_->levels.push_back(std::move(inner));
  return true;
}

void Reader::read_numbers(std::string_view name, double* values, std::size_t count, Range<double> range,
                          std::string_view unit) {
  for (const State::Found& found : state_->find(name)) {
    const toml::array* array = found.node->as_array();
    if (array == nullptr || array->size() != count) {
      state_->complain_of_type(name, found, fmt::format("a list of {} numbers", count));
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const State::Found element{found.layer, array->get(i)};
      const std::string item = fmt::format("{}[{}]", name, i);
      const auto read = element.node->is_number() ? element.node->value<double>() : std::nullopt;
      if (!read) {
        state_->complain_of_type(item, element, "a number");
      } else if (!is_within(*read, range)) {
        state_->complain_of_range(item, element, *read, range, unit);
      } else {
        values[i] = *read;
      }
    }
    state_->took(name, found);
  }
}

void Reader::line(int& value) const {
  for (const toml::table* table : state_->level().tables) {
    if (table == nullptr) continue;
    value = line_of(*table);
    return;
  }
}

void Reader::leave() {
  state_->complain_of_unknown_keys();
  state_->levels.pop_back();
}

void Reader::complain_of_section(const std::string& inconsistency) {
  if (inconsistency.empty()) return;
  const std::string& prefix = state_->level().prefix;
  const std::string where = prefix.empty() ? "" : fmt::format("[{}] ", prefix.substr(0, prefix.size() - 1));
  state_->complain_of_level(where + inconsistency);
}

std::size_t Reader::problem_count() const {
  return state_->problems.size();
}

const Provenance& Reader::provenance() const {
  return state_->provenance;
}

Result<void> Reader::finish() {
  state_->complain_of_unknown_keys();
  return state_->outcome();
}

}  // namespace cgsr::config
