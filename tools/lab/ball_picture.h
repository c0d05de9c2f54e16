#pragma once

#include <optional>
#include <string>

#include "pipeline/shade/shadow_volumes.h"
#include "platform/box.h"
#include "tools/lab/ball_film.h"
#include "tools/lab/report.h"

namespace cgsr::lab {

/// An image of a ball's film as JPEG: what may lie in shade blue, the answer with the mask green, without it yellow.
Picture picture_of(const BallFilm::Shot& shot, const shade::ShadeMasks& masks, const std::optional<Box>& with,
                   const std::optional<Box>& without, const std::string& title);

}  // namespace cgsr::lab
