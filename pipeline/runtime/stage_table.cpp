#include "pipeline/runtime/stage_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace cgsr::runtime {
namespace {

double in_us(Duration duration) {
  return static_cast<double>(duration.count()) * 1e-3;
}

template <class Summary>
void fill_times(Summary& summary, const Histogram& times) {
  summary.mean_us = in_us(times.mean());
  summary.p99_us = in_us(times.quantile(0.99));
  summary.worst_us = in_us(times.worst());
}

}  // namespace

StageTable::StageTable(const Schedule& schedule) {
  for (const auto& [name, parameters] : schedule.rows()) {
    Row row;
    row.counts.name = name;
    row.counts.budget_us = parameters.budget_us;
    rows_.push_back(std::move(row));
  }
}

void StageTable::add(const FrameRecord& record) {
  if (record.warm_up) return;
  ++frames_.frames;
  frames_.without_image += record.has_image ? 0 : 1;
  frames_.late += record.late ? 1 : 0;
  frame_times_.add(record.finished - record.started);

  const auto known = std::min<std::size_t>(rows_.size(), record.stage_count);
  for (std::size_t i = 0; i < known; ++i) {
    const auto& stage = record.stages[i];
    auto& [counts, times] = rows_[i];
    counts.not_due += stage.outcome == StageOutcome::kNotDue ? 1 : 0;
    counts.skips += stage.outcome == StageOutcome::kSkipped ? 1 : 0;
    counts.faults += stage.outcome == StageOutcome::kFaulted ? 1 : 0;
    counts.overruns += stage.overran ? 1 : 0;
    counts.refusals += stage.refused ? 1 : 0;
    if (stage.outcome == StageOutcome::kRan || stage.outcome == StageOutcome::kFaulted) {
      ++counts.runs;
      times.add(Duration{stage.elapsed_ns});
    }
  }
}

FrameSummary StageTable::frames() const {
  auto summary = frames_;
  fill_times(summary, frame_times_);
  return summary;
}

std::vector<StageSummary> StageTable::stages() const {
  std::vector<StageSummary> summaries;
  for (const auto& row : rows_) {
    summaries.push_back(row.counts);
    fill_times(summaries.back(), row.times);
  }
  return summaries;
}

std::string to_text(const StageTable& table) {
  fmt::memory_buffer text;
  auto out = fmt::appender(text);
  fmt::format_to(out, "{:<16} {:>8} {:>7} {:>8} {:>7} {:>9} {:>9} {:>9} {:>9}\n", "stage", "runs", "skips", "overruns",
                 "faults", "budget/µs", "mean/µs", "p99/µs", "worst/µs");
  for (const auto& row : table.stages()) {
    fmt::format_to(out, "{:<16} {:>8} {:>7} {:>8} {:>7} {:>9} {:>9.0f} {:>9.0f} {:>9.0f}\n", row.name, row.runs,
                   row.skips, row.overruns, row.faults, row.budget_us, row.mean_us, row.p99_us, row.worst_us);
  }
  const auto frames = table.frames();
  fmt::format_to(out, "{:<16} {:>8} {:>44.0f} {:>9.0f} {:>9.0f}\n", "whole frame", frames.frames, frames.mean_us,
                 frames.p99_us, frames.worst_us);
  fmt::format_to(out, "{} frames took longer than the time between two images, {} ran without an image\n", frames.late,
                 frames.without_image);
  return fmt::to_string(text);
}

}  // namespace cgsr::runtime
