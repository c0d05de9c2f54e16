#include "src/robot/housekeeping_task.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace cgsr::robot {
namespace {

std::string row_of(const VisionReport& report, const MotionStatus& motion) {
  const auto& object = report.decision.object;
  const auto& follow = report.decision.follow;
  std::string row =
      fmt::format("{},{:.6f},", report.record.image_sequence, to_seconds(report.record.stamp.time_since_epoch()));
  if (object.found) {
    row += fmt::format("1,{:.2f},{:.2f},{:.2f},{:.2f},{:.5f},{:.3f},{:.3f},{:.3f},", object.box.x, object.box.y,
                       object.box.width, object.box.height, object.divergence, object.light.r, object.light.g,
                       object.light.b);
  } else {
    row += "0,,,,,,,,,";
  }
  return row + fmt::format("{},{:.4f},{:.4f},{:.4f},{:.4f},{},{}", behavior::text(follow.state),
                           follow.goal.forward_mps, follow.goal.left_radps, motion.commanded.forward_mps,
                           motion.commanded.left_radps, motion.armed ? 1 : 0, text(motion.cause));
}

std::string stage_times(const runtime::FrameRecord& record, const runtime::StageTable& table) {
  std::string line = "stages, us:";
  const auto stages = table.stages();
  for (std::size_t i = 0; i < stages.size(); ++i) {
    line += fmt::format("  {} {:.0f}", stages[i].name, static_cast<double>(record.stages[i].elapsed_ns) * 1e-3);
  }
  return line;
}

}  // namespace

std::string run_csv_head() {
  return "frame,stamp_s,found,x,y,width,height,divergence,light_r,light_g,light_b,state,goal_mps,goal_radps,"
         "commanded_mps,commanded_radps,armed,stop_cause";
}

void HousekeepingTask::step() {
  while (const auto status = links_.motions.pop()) take(*status);
  while (const auto report = links_.reports.pop()) take(*report);
}

void HousekeepingTask::finish() {
  if (outputs_.video) note(outputs_.video->close());
}

void HousekeepingTask::take(const MotionStatus& status) {
  const MotionStatus& before = tally_.last_motion;
  if (tally_.beats > 0 && status.armed != before.armed) spdlog::info("motion: {}", status.armed ? "armed" : "disarmed");
  if (tally_.beats == 0 || status.cause != before.cause) {
    spdlog::info("motion: {}", status.cause == StopCause::kNone ? "free to move" : text(status.cause));
  }
  ++tally_.beats;
  const bool moves = status.sent && (status.commanded.forward_mps != 0.0 || status.commanded.left_radps != 0.0);
  tally_.beats_in_motion += moves ? 1 : 0;
  tally_.fastest_mps = std::max(tally_.fastest_mps, std::abs(status.commanded.forward_mps));
  tally_.fastest_radps = std::max(tally_.fastest_radps, std::abs(status.commanded.left_radps));
  tally_.last_motion = status;
}

void HousekeepingTask::take(const VisionReport& report) {
  ++tally_.frames;
  table_.add(report.record);
  if (const auto fault = runtime::fault_of(report.record); !fault.empty()) spdlog::error("vision: {}", fault);
  if (!report.record.has_image) {
    ++tally_.without_image;
    return;
  }
  const auto& decision = report.decision;
  if (decision.follow.state != state_) {
    spdlog::info("image {}: {} -> {} ({})", report.record.image_sequence, behavior::text(state_),
                 behavior::text(decision.follow.state), behavior::text(decision.follow.reason));
    state_ = decision.follow.state;
  }
  tally_.found += decision.object.found ? 1 : 0;
  const auto light =
      lights_.add(report.record.stamp, decision.object.found ? std::optional(decision.object.light) : std::nullopt);
  std::optional<hal::ImageTruth> truth;
  if (outputs_.simulation != nullptr) truth = outputs_.simulation->truth(report.record.stamp);
  if (truth) truths_.add(*truth, decision.object, tally_.last_motion);
  write_row(report);
  if (auto picture = picture_of(report.record.image_sequence)) {
    ++tally_.pictures;
    const ImageView& view = picture->view();
    for (int y = 0; y < view.height_px; ++y) {
      inputs_sum_.add(view.row(y), static_cast<std::size_t>(view.width_px) * 2);
    }
    draw(report, *picture, light, truth);
  }
}

std::optional<ImageLease> HousekeepingTask::picture_of(std::uint64_t sequence) {
  for (;;) {
    if (!next_picture_) next_picture_ = links_.pictures.pop();
    if (!next_picture_ || next_picture_->sequence() > sequence) return std::nullopt;
    auto picture = std::exchange(next_picture_, std::nullopt);
    if (picture->sequence() == sequence) return picture;
  }
}

void HousekeepingTask::write_row(const VisionReport& report) {
  const std::string row = row_of(report, tally_.last_motion);
  outputs_sum_.add(row.data(), row.size());
  if (outputs_.csv) note(outputs_.csv->add_line(row));
}

void HousekeepingTask::draw(const VisionReport& report, const ImageLease& picture,
                            const std::optional<color::Light>& light, const std::optional<hal::ImageTruth>& truth) {
  if (!outputs_.video) return;
  const auto& decision = report.decision;
  app::OverlayFacts facts;
  facts.image_number = report.record.image_sequence;
  if (decision.object.found) facts.box = decision.object.box;
  facts.light = light;
  facts.divergence = decision.object.divergence;
  const MotionStatus& motion = tally_.last_motion;
  facts.lines.push_back(fmt::format("{}   commanded {:+.2f} m/s {:+.2f} rad/s   {}",
                                    behavior::text(decision.follow.state), motion.commanded.forward_mps,
                                    motion.commanded.left_radps,
                                    motion.cause == StopCause::kNone ? "free to move" : text(motion.cause)));
  facts.lines.push_back(stage_times(report.record, table_));
  if (truth && truth->in_view) facts.truth = truth->box;
  const cv::Mat& overlay = outputs_.overlay->draw(picture.view(), facts);
  if (!outputs_.plan) return note(outputs_.video->add(overlay));
  app::PlanFacts plan;
  if (truth) plan.truth = *truth;
  plan.found = decision.object.found;
  plan.commanded = motion.commanded;
  plan.set_distance_m = outputs_.set_distance_m;
  cv::hconcat(overlay, outputs_.plan->draw(plan), side_by_side_);
  note(outputs_.video->add(side_by_side_));
}

void HousekeepingTask::note(const Result<void>& outcome) {
  if (outcome || !tally_.output_problem.empty()) return;
  // The robot goes on without its files; whoever started it learns at once and again from the exit code.
  tally_.output_problem = outcome.error().message;
  spdlog::error("{}; nothing more is written", tally_.output_problem);
  outputs_.csv.reset();
  outputs_.video.reset();
}

}  // namespace cgsr::robot
