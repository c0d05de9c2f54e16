#include "src/sinks/profile.h"

#include <algorithm>
#include <cstddef>

namespace cgsr::sinks {
namespace {

using Json = nlohmann::ordered_json;

double in_us(Duration duration) {
  return static_cast<double>(duration.count()) * 1e-3;
}

Json times_json(const runtime::Histogram& times) {
  return {{"mean_us", in_us(times.mean())},
          {"p50_us", in_us(times.quantile(0.5))},
          {"p99_us", in_us(times.quantile(0.99))},
          {"worst_us", in_us(times.worst())}};
}

}  // namespace

Profile::Profile(const runtime::Schedule& schedule) : period_(schedule.frame_period()) {
  for (const auto& [name, parameters] : schedule.rows()) {
    Stage stage;
    stage.name = name;
    stage.budget_us = parameters.budget_us;
    stages_.push_back(std::move(stage));
  }
}

void Profile::add(const runtime::FrameRecord& record) {
  if (record.warm_up) return;
  ++frames_;
  without_image_ += record.has_image ? 0 : 1;
  late_ += record.late ? 1 : 0;
  const Duration took = record.finished - record.started;
  frame_times_.add(took);
  ++frame_bins_[static_cast<std::size_t>(std::clamp<std::int64_t>(10 * took / period_, 0, kBins - 1))];
  const auto known = std::min<std::size_t>(stages_.size(), record.stage_count);
  for (std::size_t i = 0; i < known; ++i) {
    const runtime::StageRecord& one = record.stages[i];
    Stage& stage = stages_[i];
    stage.not_due += one.outcome == runtime::StageOutcome::kNotDue ? 1 : 0;
    stage.skips += one.outcome == runtime::StageOutcome::kSkipped ? 1 : 0;
    stage.faults += one.outcome == runtime::StageOutcome::kFaulted ? 1 : 0;
    stage.overruns += one.overran ? 1 : 0;
    stage.ended_by_budget += one.refused ? 1 : 0;
    if (one.outcome != runtime::StageOutcome::kRan && one.outcome != runtime::StageOutcome::kFaulted) continue;
    ++stage.runs;
    stage.times.add(Duration{one.elapsed_ns});
  }
}

void Profile::add(const MotionStatus& status) {
  ++cycles_;
  late_cycles_ += status.late ? 1 : 0;
  ++causes_[std::min(static_cast<std::size_t>(status.cause), kCauses - 1)];
  if (status.goal_stamp > last_goal_) {
    last_goal_ = status.goal_stamp;
    to_command_.add(status.stamp - status.goal_stamp);
  }
  last_motion_ = status;
}

Json Profile::json() const {
  Json json;
  json["images"] = frames_ - without_image_;
  json["stages"] = Json::object();
  for (const Stage& stage : stages_) {
    Json row{{"runs", stage.runs},          {"not_due", stage.not_due}, {"skips", stage.skips},
             {"overruns", stage.overruns},  {"faults", stage.faults},   {"ended_by_budget", stage.ended_by_budget},
             {"budget_us", stage.budget_us}};
    row.update(times_json(stage.times));
    row["share_of_budget"] = stage.budget_us > 0 ? in_us(stage.times.mean()) / stage.budget_us : 0.0;
    json["stages"][stage.name] = std::move(row);
  }
  json["frame"] = {
      {"frames", frames_}, {"without_image", without_image_}, {"late", late_}, {"budget_us", in_us(period_)}};
  json["frame"].update(times_json(frame_times_));
  json["frame"]["tenths_of_period"] = frame_bins_;
  json["exposure_to_command"] = times_json(to_command_);
  json["exposure_to_command"]["images"] = to_command_.count();
  json["motion"] = {{"control_cycles", cycles_},
                    {"late_cycles", late_cycles_},
                    {"armed", last_motion_.armed},
                    {"stop_cause", to_string(last_motion_.cause)},
                    {"latched", to_string(last_motion_.latched)},
                    {"drive_fault", hal::to_string(last_motion_.drive_fault)},
                    {"commanded_mps", last_motion_.commanded.forward_mps},
                    {"commanded_radps", last_motion_.commanded.left_radps}};
  json["stop_causes"] = Json::object();
  for (std::size_t i = 0; i <= static_cast<std::size_t>(StopCause::kDisarmed); ++i) {
    if (causes_[i] > 0) json["stop_causes"][std::string(to_string(static_cast<StopCause>(i)))] = causes_[i];
  }
  return json;
}

}  // namespace cgsr::sinks
