#pragma once

#include <string>

#include "pipeline/illumination/board.h"
#include "platform/error.h"
#include "src/config/light.h"
#include "src/input/image_input.h"

namespace cgsr::app {

/// What every look at the probes needs.
struct LightSetup {
  config::Light config;
  illumination::Board board;
  ImageInput input;
};

/// \param config_file  as config/illumination/lamp-robot.toml, or a robot's file.  \param camera_file  intrinsics.  \param mount_file  a robot.toml
///        with the mount and perhaps the board, before what `config_file` says; empty: none.  \param images  video, image folder or image, of the camera's size.
Result<LightSetup> open_light_setup(const std::string& config_file, const std::string& camera_file,
                                    const std::string& mount_file, const std::string& images);

}  // namespace cgsr::app
