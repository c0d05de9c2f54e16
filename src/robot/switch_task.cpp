#include "src/robot/switch_task.h"

namespace cgsr::robot {

std::optional<std::string> SwitchTask::step() {
  if (arming_line_.empty()) return std::nullopt;
  const auto level = switches_.read(arming_line_);
  if (!level) {
    const bool news = level_.value_or(true);
    level_ = false;
    if (!news) return std::nullopt;
    static_cast<void>(links_.arm_requests.push(ArmRequest::kDisarm));
    return level.error().message;
  }
  if (level_ && *level_ != *level) {
    // A request that finds no room is repeated at the next look, for the level is not taken over.
    if (!links_.arm_requests.push(*level ? ArmRequest::kArm : ArmRequest::kDisarm)) return std::nullopt;
  }
  level_ = *level;
  return std::nullopt;
}

}  // namespace cgsr::robot
