#pragma once

#include <string>

#include "platform/error.h"
#include "src/config/load.h"
#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// \return the robot with the probe board as it ships (config/robots/sim-home-lamp.toml), or the one that `--config` names.
Result<config::Robot> lamp_robot(const Setting& setting);

/// \return the file of the robot that a closed loop runs with: the shipped one of this name, or the one that `--config` names.
std::string robot_file(const Setting& setting, const std::string& name);

// The hash of exactly the sections that a table measures with, for the register of experiments.
Result<std::string> color_hash(const Setting& setting);         ///< [color]
Result<std::string> localization_hash(const Setting& setting);  ///< config/localization/floor.toml and free.toml
Result<std::string> lamp_hash(const Setting& setting);          ///< [probes] and [lamp] of lamp_robot()
Result<std::string> shade_hash(const Setting& setting);         ///< its [shade] and [stage.shade]
Result<std::string> ball_hash(
    const Setting& setting);  ///< [color] of the command, its [integrated], [shade], [stage.shade] and [stage.track]
Result<std::string> lamp_robot_hash(const Setting& setting);    ///< all of lamp_robot()
Result<std::string> home_robot_hash(const Setting& setting);    ///< all of sim-home
Result<std::string> people_robot_hash(const Setting& setting);  ///< all of sim-people
Result<std::string> round_robot_hash(const Setting& setting);   ///< all of sim-home-round

}  // namespace cgsr::lab
