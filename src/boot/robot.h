#pragma once

#include <memory>
#include <string>
#include <vector>

#include "platform/stop.h"
#include "src/boot/boot_plan.h"
#include "src/boot/robot_state.h"

namespace cgsr::boot {

/// A robot, put together from its file by the steps of robot_plan.h.
class Robot {
 public:
  /// \return the robot, booted; or the error of the first step that failed: nothing behind it was touched, and what was opened before it is
  ///         closed again.
  static Result<std::unique_ptr<Robot>> build(const config::Robot& config, const RunOptions& options);

  /// Walks every step that can be walked and moves nothing. \return every problem that a run would meet, and what there is to say else.
  struct Check {
    std::vector<Error> problems;
    std::unique_ptr<Robot> robot;
  };
  static Check check(const config::Robot& config);

  /// Runs until the images end, the duration is over or `stop` is requested; zero is the last command in any case.
  Result<void> run(StopRequest& stop);

  [[nodiscard]] const RobotState& state() const { return state_; }

  /// What the run came to. \param ended_by  why it is over, for people. Ends the digests: to be called once.
  [[nodiscard]] sinks::Summary summary(const std::string& ended_by);

 private:
  Robot(const config::Robot& config, const RunOptions& options);

  RobotState state_;
  BootPlan plan_;
};

}  // namespace cgsr::boot
