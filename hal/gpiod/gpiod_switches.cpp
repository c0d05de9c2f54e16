#include "hal/gpiod/gpiod_switches.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace cgsr::hal::gpiod {

GpiodSwitches::GpiodSwitches(std::vector<LineWish> lines, std::unique_ptr<LineAccess> access, const Clock& clock)
    : access_(std::move(access)), clock_(clock) {
  for (auto& wish : lines) lines_.emplace_back().wish = std::move(wish);
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
    line.reported = false;
  }
  started_ = true;
  next_request_ = MonoTime{};
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

/// Gives the line back. \return that it does not answer: with the errno, or with what its last request came to.
tl::unexpected<Error> GpiodSwitches::lost(Line& line, int error) {
  const bool noticed_now = line.handle.has_value();
  if (noticed_now) why_gone_ = std::generic_category().message(error);
  line.reported = true;
  if (noticed_now) give_back(line);
  return tl::unexpected(
      Error{fmt::format("line '{}' does not answer ({}){}; it is requested again every {} s", line.wish.name, why_gone_,
                        line.wish.output ? ": every output was switched off" : "", to_seconds(kLineWait))});
}

void GpiodSwitches::give_back(Line& line) {
  access_->release(*line.handle);
  line.handle.reset();
  line.on = false;
  next_request_ = clock_.now() + kLineWait;
}

/// The lines of a chip that is gone are given back together: as long as one is held, the chip's number is not free.
void GpiodSwitches::give_back_outputs_that_do_not_answer() {
  for (auto& line : lines_) {
    if (line.wish.output && line.handle && access_->set(*line.handle, line.on) != 0) give_back(line);
  }
}

void GpiodSwitches::request_again() {
  const auto due = [](const Line& line) { return !line.handle && line.reported; };
  if (clock_.now() < next_request_ || std::none_of(lines_.begin(), lines_.end(), due)) return;
  next_request_ = clock_.now() + kLineWait;
  for (auto& line : lines_) {
    if (!due(line)) continue;
    auto handle = access_->request(line.wish);
    if (!handle) {
      why_gone_ = handle.error().message;
      continue;
    }
    line.handle = *handle;
    line.on = false;
    line.reported = false;
  }
}

Result<void> GpiodSwitches::set(std::string_view name, bool on) {
  const auto found = find(name);
  if (!found) return tl::unexpected(found.error());
  Line& line = **found;
  if (!line.wish.output) return fail(fmt::format("line '{}' is an input: it cannot be set", name));
  request_again();
  const int error = line.handle ? access_->set(*line.handle, on) : ENODEV;
  if (error == 0) {
    line.on = on;
    return {};
  }
  auto problem = lost(line, error);
  all_off();
  return problem;
}

Result<bool> GpiodSwitches::read(std::string_view name) {
  const auto found = find(name);
  if (!found) return tl::unexpected(found.error());
  Line& line = **found;
  if (line.wish.output) return line.on;
  request_again();
  bool on = false;
  const int error = line.handle ? access_->read(*line.handle, on) : ENODEV;
  if (error == 0) return on;
  auto problem = lost(line, error);
  give_back_outputs_that_do_not_answer();
  return problem;
}

void GpiodSwitches::all_off() {
  for (auto& line : lines_) line.on = false;
  give_back_outputs_that_do_not_answer();  // one that does not answer must not keep the others on
}

void GpiodSwitches::stop() {
  if (!started_) return;
  all_off();
  access_->release_all();
  for (auto& line : lines_) line.handle.reset();
  started_ = false;
}

}  // namespace cgsr::hal::gpiod
