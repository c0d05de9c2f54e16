#include "hal/gpiod/gpiod_switches.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace cgsr::hal::gpiod {

GpiodSwitches::GpiodSwitches(std::vector<LineWish> lines, std::unique_ptr<LineAccess> access)
    : access_(std::move(access)) {
  for (auto& wish : lines) lines_.push_back({.wish = std::move(wish)});
}

GpiodSwitches::~GpiodSwitches() {
  GpiodSwitches::stop();
}

Result<void> GpiodSwitches::start() {
  if (started_) return fail("the lines are started already");
  for (auto& line : lines_) {
    auto handle = access_->request(line.wish);
    if (!handle) {
      access_->release_all();  // those before it are off
      return tl::unexpected(handle.error());
    }
    line.handle = *handle;
    line.on = false;
  }
  started_ = true;
  return {};
}

std::vector<std::string> GpiodSwitches::names() const {
  std::vector<std::string> names;
  for (const auto& line : lines_) names.push_back(line.wish.name);
  return names;
}

Result<GpiodSwitches::Line*> GpiodSwitches::find(std::string_view name) {
  const auto found =
      std::find_if(lines_.begin(), lines_.end(), [name](const Line& line) { return line.wish.name == name; });
  if (found == lines_.end()) return fail(fmt::format("there is no line '{}' in the configuration", name));
  if (!started_) return fail(fmt::format("line '{}': the lines are not started", name));
  return &*found;
}

Result<void> GpiodSwitches::set(std::string_view name, bool on) {
  const auto line = find(name);
  if (!line) return tl::unexpected(line.error());
  if (!(*line)->wish.output) return fail(fmt::format("line '{}' is an input: it cannot be set", name));
  if (const int error = access_->set((*line)->handle, on); error != 0) {
    all_off();
    return fail(fmt::format("line '{}' does not answer ({}): every output was switched off", name,
                            std::generic_category().message(error)));
  }
  (*line)->on = on;
  return {};
}

Result<bool> GpiodSwitches::read(std::string_view name) {
  const auto line = find(name);
  if (!line) return tl::unexpected(line.error());
  if ((*line)->wish.output) return (*line)->on;
  bool on = false;
  if (const int error = access_->read((*line)->handle, on); error != 0) {
    return fail(fmt::format("line '{}' cannot be read ({})", name, std::generic_category().message(error)));
  }
  return on;
}

void GpiodSwitches::all_off() {
  for (auto& line : lines_) {
    if (!line.wish.output) continue;
    (void)access_->set(line.handle, false);  // one that does not answer must not keep the others on
    line.on = false;
  }
}

void GpiodSwitches::stop() {
  if (!started_) return;
  all_off();
  access_->release_all();
  started_ = false;
}

}  // namespace cgsr::hal::gpiod
