#pragma once

#include <string>

#include "src/robot/robot.h"

namespace cgsr::robot {

/// The end of a run for people: images, object, motion, stages, rings.
std::string summary_text(Robot& robot, const std::string& ended_by);

/// The same for machines (docs/architecture.md lists the keys). Ends the sums: call it once.
std::string summary_json(Robot& robot, const std::string& ended_by);

}  // namespace cgsr::robot
