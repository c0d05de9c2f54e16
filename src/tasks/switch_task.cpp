#include "src/tasks/switch_task.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace cgsr::tasks {

std::optional<std::string> SwitchTask::step() {
  while (const auto request = links_.switch_requests.pop()) switch_lamp(*request);
  return watch_arming();
}

std::optional<std::string> SwitchTask::watch_arming() {
  if (lines_.arming.empty()) return std::nullopt;
  const auto level = switches_.read(lines_.arming);
  const MonoTime now = clock_.now();
  const bool fell_silent = !level && !silent_;
  // Motion has stopped the robot meanwhile, or not quite yet, and an arming may be pending: an edge may have been missed.
  const bool hung = level && level_ && links_.arming_report.is_old(now);
  if (fell_silent || hung) {
    // Ahead of the report: whoever takes the line for read has the request. One that finds no room is repeated at the
    // next look, and the report grows older until then.
    if (!links_.arm_requests.push(ArmRequest::kDisarm)) return std::nullopt;
    level_.reset();
    silent_ = true;
  }
  links_.arming_report.report(now);  // before a request to arm, which motion would refuse else
  if (!level) return fell_silent ? std::optional(level.error().message) : std::nullopt;
  if (level_ && *level_ != *level) {
    // A request that finds no room is repeated at the next look, for the level is not taken over.
    if (!links_.arm_requests.push(*level ? ArmRequest::kArm : ArmRequest::kDisarm)) return std::nullopt;
  }
  level_ = *level;
  if (!std::exchange(silent_, false)) return std::nullopt;
  return fmt::format("line '{}' answers again: it arms when it is switched off and on", lines_.arming);
}

void SwitchTask::switch_lamp(const stages::SwitchRequest& request) {
  const auto done = switches_.set(lines_.lamps[static_cast<std::size_t>(request.line)], request.on);
  sinks::SwitchRecord record;
  record.answer = {request, done.has_value(), clock_.now()};
  if (!done) {
    const std::string& words = done.error().message;
    std::copy_n(words.begin(), std::min(words.size(), record.problem.size() - 1), record.problem.begin());
  }
  // An answer that finds no room is missed by vision in time: the line then counts as silent.
  static_cast<void>(links_.switch_answers.push(stages::SwitchAnswer(record.answer)));
  links_.switchings.push(record);
}

Result<void> check_lines(const hal::Switches& switches, const SwitchLines& lines) {
  const auto there = switches.names();
  std::string problems;
  const auto check = [&](const std::string& name) {
    if (name.empty() || std::find(there.begin(), there.end(), name) != there.end()) return;
    problems += fmt::format("switches: there is no line '{}'; there are: {}\n", name, fmt::join(there, ", "));
  };
  check(lines.arming);
  for (const std::string& name : lines.lamps) check(name);
  if (problems.empty()) return {};
  problems.pop_back();
  return fail(std::move(problems));
}

}  // namespace cgsr::tasks
