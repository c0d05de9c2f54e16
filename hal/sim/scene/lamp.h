#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/scene/material.h"

namespace cgsr::sim {

/// What a light does over time: between two keys its brightness and colour change linearly; before the first and after the last they
/// hold. No keys: always (1, 1, 1).
struct LightKey {
  double at_s = 0.0;
  Rgb factor = Rgb::Ones();  ///< multiplies the light, channel by channel.
};

/// A lamp that shines equally in every direction. A point casts hard shadows; a ball of radius > 0 soft ones.
struct Lamp {
  std::string name;
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();  ///< of a lamp that a robot carries: p_RL, in the robot's frame.
  int carried_by = -1;                             ///< index of the figure that carries it, or -1.
  double radius_m = 0.0;
  Rgb color = Rgb::Ones();  ///< linear, relative; the brightest channel carries `lumens`.
  double lumens = 800.0;
  double bounce =
      0.0;  ///< of its light, the part that comes back from walls as ambient light everywhere: lux per lumen [1/m^2].
  bool visible = true;      ///< a ball that the camera sees glowing (only when radius > 0).
  bool on = true;           ///< when no switch is named.
  std::string switch_name;  ///< on and off with this line.
  std::vector<LightKey> script;
};

/// Light from everywhere, as a white sky and pale walls give it.
struct Ambient {
  Rgb illuminance_lux = Rgb::Zero();  ///< on a free surface that looks up.
  double from_below = 0.6;            ///< what a surface that looks down gets of it.
  double corner_reach_m = 0.8;        ///< how far corners and furniture take it away; 0: everywhere the same.
  std::vector<LightKey> script;
};

/// The factor of a script at a time.
Rgb factor_at(const std::vector<LightKey>& script, double time_s);

}  // namespace cgsr::sim
