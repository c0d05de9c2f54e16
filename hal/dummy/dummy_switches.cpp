#include "hal/dummy/dummy_switches.h"

#include <set>

#include <fmt/format.h>

namespace cgsr::hal {

std::string_view to_string(LineDirection direction) {
  switch (direction) {
    case LineDirection::kOutput:
      return "output";
    case LineDirection::kInput:
      return "input";
  }
  return "";
}

Result<void> DummySwitches::start() {
  const std::lock_guard lock(mutex_);
  if (started_) return fail("dummy switches: started twice");
  std::set<std::string_view> seen;
  for (const DummyLine& line : lines_) {
    if (line.name.empty()) return fail("dummy switches: a line has no name");
    if (!seen.insert(line.name).second) return fail(fmt::format("dummy switches: two lines are named '{}'", line.name));
  }
  release_outputs();
  started_ = true;
  return {};
}

std::vector<std::string> DummySwitches::names() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names;
  for (const DummyLine& line : lines_) names.push_back(line.name);
  return names;
}

Result<void> DummySwitches::set(std::string_view name, bool on) {
  const std::lock_guard lock(mutex_);
  const auto line = find(name, "set");
  if (!line) return tl::unexpected(line.error());
  if ((*line)->direction == LineDirection::kInput) {
    return fail(fmt::format("dummy switches: cannot set '{}': it is an input", name));
  }
  (*line)->on = on;
  return {};
}

Result<bool> DummySwitches::read(std::string_view name) {
  const std::lock_guard lock(mutex_);
  return find(name, "read").map([](const DummyLine* line) { return line->on; });
}

void DummySwitches::stop() {
  const std::lock_guard lock(mutex_);
  if (started_) release_outputs();
  started_ = false;
}

bool DummySwitches::press(std::string_view name, bool on) {
  const std::lock_guard lock(mutex_);
  for (DummyLine& line : lines_) {
    if (line.name == name && line.direction == LineDirection::kInput) {
      line.on = on;
      return true;
    }
  }
  return false;
}

bool DummySwitches::level(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  for (const DummyLine& line : lines_) {
    if (line.name == name) return line.on;
  }
  return false;
}

Result<DummyLine*> DummySwitches::find(std::string_view name, std::string_view purpose) {
  if (!started_) return fail(fmt::format("dummy switches: cannot {} '{}': not started", purpose, name));
  for (DummyLine& line : lines_) {
    if (line.name == name) return &line;
  }
  return fail(fmt::format("dummy switches: cannot {} '{}': there is no line of that name", purpose, name));
}

void DummySwitches::release_outputs() {
  for (DummyLine& line : lines_) {
    if (line.direction == LineDirection::kOutput) line.on = false;
  }
}

}  // namespace cgsr::hal
