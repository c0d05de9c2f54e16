#include "hal/sim/switches/simulated_switches.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace cgsr::sim {

SimulatedSwitches::SimulatedSwitches(std::vector<SwitchLine> lines, std::vector<SwitchEvent> script)
    : script_(std::move(script)) {
  for (auto& line : lines) lines_.push_back({.line = std::move(line)});
}

Result<void> SimulatedSwitches::start() {
  const std::lock_guard lock(mutex_);
  if (started_) return fail("simulated switches: started twice");
  for (const auto& state : lines_) {
    const auto& name = state.line.name;
    if (name.empty()) return fail("simulated switches: a line has no name");
    if (find(name) != &state) return fail(fmt::format("simulated switches: two lines are named '{}'", name));
  }
  for (const auto& event : script_) {
    const State* state = find(event.line);
    if (state == nullptr)
      return fail(fmt::format("simulated switches: the script names '{}', which is no line", event.line));
    if (event.what == SwitchHappening::kPressed && !state->line.is_input) {
      return fail(fmt::format("simulated switches: the script presses '{}', which is an output", event.line));
    }
    if (event.what == SwitchHappening::kStuck && state->line.is_input) {
      return fail(fmt::format("simulated switches: the script has '{}' stuck, which is an input", event.line));
    }
  }
  all_off();
  started_ = true;
  return {};
}

std::vector<std::string> SimulatedSwitches::names() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const auto& state : lines_) names.push_back(state.line.name);
  return names;
}

Result<void> SimulatedSwitches::set(std::string_view name, bool on) {
  const std::lock_guard lock(mutex_);
  if (auto possible = usable(name, "set"); !possible) return possible;
  for (auto& state : lines_) {
    if (state.line.name != name) continue;
    if (state.line.is_input) return fail(fmt::format("simulated switches: cannot set '{}': it is an input", name));
    state.set = on;
    if (!happens(SwitchHappening::kStuck, name)) state.level = on;
  }
  return {};
}

Result<bool> SimulatedSwitches::read(std::string_view name) {
  const std::lock_guard lock(mutex_);
  if (auto possible = usable(name, "read"); !possible) return tl::unexpected(possible.error());
  const State& state = *find(name);
  if (!state.line.is_input) return state.set;
  return state.pressed || happens(SwitchHappening::kPressed, name);
}

void SimulatedSwitches::stop() {
  const std::lock_guard lock(mutex_);
  if (started_) all_off();
  started_ = false;
}

void SimulatedSwitches::advance_to(MonoTime time) {
  const std::lock_guard lock(mutex_);
  now_ = std::max(now_, time);
}

bool SimulatedSwitches::level(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  const State* state = find(name);
  if (state == nullptr) return false;
  return state->line.is_input ? state->pressed || happens(SwitchHappening::kPressed, name) : state->level;
}

bool SimulatedSwitches::press(std::string_view name, bool on) {
  const std::lock_guard lock(mutex_);
  for (auto& state : lines_) {
    if (state.line.name != name || !state.line.is_input) continue;
    state.pressed = on;
    return true;
  }
  return false;
}

const SimulatedSwitches::State* SimulatedSwitches::find(std::string_view name) const {
  const auto found = std::find_if(lines_.begin(), lines_.end(), [name](const State& s) { return s.line.name == name; });
  return found == lines_.end() ? nullptr : &*found;
}

bool SimulatedSwitches::happens(SwitchHappening what, std::string_view name) const {
  return std::any_of(script_.begin(), script_.end(), [&](const SwitchEvent& event) {
    return event.what == what && event.line == name && event.from <= now_ && now_ < event.to;
  });
}

Result<void> SimulatedSwitches::usable(std::string_view name, std::string_view purpose) const {
  if (!started_) return fail(fmt::format("simulated switches: cannot {} '{}': not started", purpose, name));
  if (find(name) == nullptr) {
    return fail(fmt::format("simulated switches: cannot {} '{}': there is no line of that name", purpose, name));
  }
  if (happens(SwitchHappening::kNoAnswer, name)) {
    return fail(fmt::format("simulated switches: cannot {} '{}': the line does not answer", purpose, name));
  }
  return {};
}

void SimulatedSwitches::all_off() {
  for (auto& state : lines_) state.set = state.level = false;
}

}  // namespace cgsr::sim
