#pragma once

#include <string>

#include "src/config/robot.h"
#include "src/output/output_claims.h"

namespace cgsr::app {

/// Names a configuration file and the files that it extends as inputs. \param file  empty: none.
void reads_configuration(OutputClaims& files, const std::string& file, const std::string& option);

/// Names the files that a robot was read from, and every file that it names itself: images, model, map, calibration.
void reads_robot(OutputClaims& files, const config::Robot& robot);

}  // namespace cgsr::app
