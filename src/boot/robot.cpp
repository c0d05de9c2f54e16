#include "src/boot/robot.h"

#include <utility>

#include <fmt/format.h>

#include "platform/config/canonical.h"
#include "src/boot/boot_pose.h"
#include "src/boot/robot_plan.h"
#include "src/boot/run_loops.h"
#include "src/tasks/ring_report.h"

namespace cgsr::boot {
namespace {

void add_rings(const tasks::Links& links, sinks::Summary& summary) {
  const auto& capture = links.capture;
  summary.json["capture"] = {{"images", capture.images.load()},
                             {"timeouts", capture.timeouts.load()},
                             {"no_slot", capture.no_slot.load()},
                             {"corrupt", capture.corrupt.load()},
                             {"disconnected", capture.disconnected.load()}};
  summary.json["rings"] = tasks::rings_json(links);
  summary.text += "\nring          capacity  high water  pushed  dropped  skipped\n";
  tasks::visit_rings(links, [&summary](const char* name, const RingStatistics& ring) {
    summary.text += fmt::format("{:<14}{:>8}{:>12}{:>8}{:>9}{:>9}\n", name, ring.capacity, ring.high_water, ring.pushed,
                                ring.dropped, ring.skipped);
  });
}

/// A run that commands nothing outdates no pose, nor does one that knows none for want of a map.
bool outdates_last_pose(const RobotState& state) {
  const bool localizes = state.vision.map && state.calibration.camera;
  return localizes && !state.setup.options.dry_run && !state.setup.config.localization.start.file.empty();
}

/// Only a pose that the robot was sure of to the end is worth anything to the next run; or the last run's, where it never moved.
/// \param last_pose  what was withdrawn; empty: nothing.
Result<void> leave_pose_for_next_run(const RobotState& state, const std::string& last_pose) {
  const behavior::PlanarPose& robot = state.outputs.statistics->run().last_pose.robot;
  const std::string& file = state.setup.config.localization.start.file;
  if (file.empty()) return {};
  if (robot.known) return leave_pose(file, geometry::pose_on_floor(robot.x_m, robot.y_m, robot.heading_rad));
  if (last_pose.empty() || state.devices.base->was_armed()) return {};
  return put_back_pose(file, last_pose);
}

}  // namespace

Robot::Robot(const config::Robot& config, const RunOptions& options) {
  state_.setup = {config, options};
  add_robot_steps(plan_, state_);
}

Result<std::unique_ptr<Robot>> Robot::build(const config::Robot& config, const RunOptions& options) {
  std::unique_ptr<Robot> robot(new Robot(config, options));
  if (auto booted = robot->plan_.run(); !booted) return tl::unexpected(booted.error());
  return robot;
}

Robot::Check Robot::check(const config::Robot& config) {
  Check check;
  check.robot.reset(new Robot(config, {}));
  check.problems = check.robot->plan_.check();
  return check;
}

Result<void> Robot::run(StopRequest& stop) {
  std::string last_pose;
  if (outdates_last_pose(state_)) {
    auto withdrawn = withdraw_pose(state_.setup.config.localization.start.file);
    if (!withdrawn) return tl::unexpected(withdrawn.error());
    last_pose = std::move(*withdrawn);
  }
  Result<void> done = state_.setup.live() ? run_live(state_, stop) : run_lock_step(state_, stop);
  state_.outputs.sinks.finish();
  if (auto left = leave_pose_for_next_run(state_, last_pose); !left && done) return left;
  return done;
}

sinks::Summary Robot::summary(const std::string& ended_by) {
  const config::Robot& config = state_.setup.config;
  sinks::Summary summary = state_.outputs.sinks.summary();
  summary.text = fmt::format("\nended by {}\n", ended_by) + summary.text;
  summary.json["config_sha256"] = config::hash(config);
  summary.json["color_sha256"] = config::hash(config.color);
  summary.json["ended_by"] = ended_by;
  summary.json["problems"] = state_.report.problems;
  for (const std::string& problem : state_.report.problems) summary.text += fmt::format("problem: {}\n", problem);
  add_rings(state_.links, summary);
  summary.text += fmt::format("\nconfiguration {}\n", config::hash(config));
  return summary;
}

}  // namespace cgsr::boot
