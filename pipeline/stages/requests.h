#pragma once

#include <array>
#include <optional>

#include "pipeline/illumination/active_check.h"
#include "pipeline/person/classifier.h"
#include "pipeline/stages/switchboard.h"

namespace cgsr::stages {

/// What the decision about one image asks of the stages and devices at the next one.
/// Ours; it serves Alg. 5.2 and the checks of the probes (5.1).
struct Requests {
  bool track = true;                               ///< the object is to be looked for.
  std::optional<illumination::CheckedLamp> check;  ///< the lamp to be switched for a check of the probes' shadows.
  std::array<bool, kLampLines> lamps{};            ///< the level that each switched lamp should have, by LampLine.
  std::optional<person::Label> person{};           ///< whose face counts where several people are in view.
};

/// The switched lamps' lines as an image shows them, by LampLine.
using LampLines = std::array<illumination::LineState, kLampLines>;

}  // namespace cgsr::stages
