#include "pipeline/runtime/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace cgsr::runtime {
namespace {

constexpr std::uint64_t kLongestHyperperiod = 10'000;  // frames: five minutes, and a check that ends
constexpr int kFramesShown = 5;

std::int64_t in_us(Duration duration) {
  return std::chrono::duration_cast<std::chrono::microseconds>(duration).count();
}

std::vector<std::string> problems_of_rows(const std::vector<ScheduleRow>& rows) {
  std::vector<std::string> problems;
  if (rows.size() > kMostStages) {
    problems.push_back(fmt::format("{} stages are more than {}", rows.size(), kMostStages));
  }
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    const auto same_name = [&](const ScheduleRow& other) { return other.name == row->name; };
    if (row->name.empty()) problems.emplace_back("a stage has no name");
    if (std::any_of(rows.begin(), row, same_name))
      problems.push_back(fmt::format("stage '{}' is there twice", row->name));
    const auto& [every_frames, phase, budget_us, units, on_overrun] = row->parameters;
    if (every_frames < 1 || budget_us < 1 || units < 0) {
      problems.push_back(
          fmt::format("stage '{}': every_frames = {} and budget_us = {} must be positive, units = {} not negative",
                      row->name, every_frames, budget_us, units));
    } else if (auto inconsistency = row->parameters.inconsistency(); !inconsistency.empty()) {
      problems.push_back(fmt::format("stage '{}': {}", row->name, inconsistency));
    }
  }
  return problems;
}

std::optional<std::uint64_t> hyperperiod_of(const std::vector<ScheduleRow>& rows) {
  std::uint64_t frames = 1;
  for (const auto& row : rows) {
    frames = std::lcm(frames, static_cast<std::uint64_t>(row.parameters.every_frames));
    if (frames > kLongestHyperperiod) return std::nullopt;
  }
  return frames;
}

/// decode 1500 + track 7000 = 8500 µs
std::string sum_in_words(const Schedule& schedule, std::uint64_t frame) {
  std::string words;
  for (std::size_t i = 0; i < schedule.rows().size(); ++i) {
    if (!schedule.due(i, frame)) continue;
    const auto& row = schedule.rows()[i];
    words += fmt::format("{}{} {}", words.empty() ? "" : " + ", row.name, row.parameters.budget_us);
  }
  return fmt::format("{} = {} µs", words, in_us(schedule.planned(frame)));
}

std::vector<std::string> problems_of_frames(const Schedule& schedule) {
  std::vector<std::string> problems;
  std::uint64_t too_full = 0;
  for (std::uint64_t frame = 0; frame < schedule.hyperperiod_frames(); ++frame) {
    if (schedule.planned(frame) <= schedule.frame_period()) continue;
    if (++too_full > kFramesShown) continue;
    problems.push_back(fmt::format("frame {} of {} is planned for more than the {} µs between two images: {}", frame,
                                   schedule.hyperperiod_frames(), in_us(schedule.frame_period()),
                                   sum_in_words(schedule, frame)));
  }
  if (too_full > kFramesShown) problems.push_back(fmt::format("and {} frames more", too_full - kFramesShown));
  return problems;
}

}  // namespace

std::string StageParameters::inconsistency() const {
  if (phase < every_frames) return {};
  return fmt::format("phase = {} is never reached with every_frames = {}", phase, every_frames);
}

Schedule::Schedule(std::vector<ScheduleRow> rows, Duration frame_period, std::uint64_t hyperperiod)
    : rows_(std::move(rows)), frame_period_(frame_period), hyperperiod_(hyperperiod) {}

Result<Schedule> Schedule::make(std::vector<ScheduleRow> rows, Duration frame_period) {
  auto problems = problems_of_rows(rows);
  if (frame_period <= Duration::zero()) problems.emplace_back("the time between two images must be positive");
  if (problems.empty()) {
    if (const auto hyperperiod = hyperperiod_of(rows)) {
      Schedule schedule(std::move(rows), frame_period, *hyperperiod);
      problems = problems_of_frames(schedule);
      if (problems.empty()) return schedule;
    } else {
      problems.push_back(
          fmt::format("the pattern repeats only after more than {} frames: choose every_frames with common factors",
                      kLongestHyperperiod));
    }
  }
  return fail(fmt::format("the schedule does not hold:\n  {}", fmt::join(problems, "\n  ")));
}

bool Schedule::due(std::size_t row, std::uint64_t frame) const {
  const auto& parameters = rows_[row].parameters;
  return frame % static_cast<std::uint64_t>(parameters.every_frames) == static_cast<std::uint64_t>(parameters.phase);
}

Duration Schedule::planned(std::uint64_t frame) const {
  Duration sum{};
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (due(i, frame)) sum += std::chrono::microseconds(rows_[i].parameters.budget_us);
  }
  return sum;
}

std::optional<std::size_t> Schedule::find(std::string_view name) const {
  const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const ScheduleRow& row) { return row.name == name; });
  if (found == rows_.end()) return std::nullopt;
  return static_cast<std::size_t>(std::distance(rows_.begin(), found));
}

std::string to_text(const Schedule& schedule) {
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "{:<16} {:>5} {:>5} {:>9} {:>7}  {}\n", "stage", "every", "phase", "budget/µs", "units",
                 "on overrun");
  for (const auto& [name, row] : schedule.rows()) {
    fmt::format_to(out, "{:<16} {:>5} {:>5} {:>9} {:>7}  {}\n", name, row.every_frames, row.phase, row.budget_us,
                   row.units == 0 ? "all" : std::to_string(row.units), to_string(row.on_overrun));
  }
  std::uint64_t fullest = 0;
  for (std::uint64_t frame = 1; frame < schedule.hyperperiod_frames(); ++frame) {
    if (schedule.planned(frame) > schedule.planned(fullest)) fullest = frame;
  }
  fmt::format_to(out, "repeats every {} frames; the fullest, frame {}, is planned for {} of {} µs\n",
                 schedule.hyperperiod_frames(), fullest, in_us(schedule.planned(fullest)),
                 in_us(schedule.frame_period()));
  return fmt::to_string(text);
}

}  // namespace cgsr::runtime
