#pragma once

#include <memory>

#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/render/expectation.h"
#include "pipeline/world/map.h"
#include "platform/error.h"

namespace cgsr {

/// What a localizer asks for visible edges, as its configuration says.
///
/// \param map  outlives it.  \return null for `raster`, which the localizer makes itself; for `osmesa` OpenGL's, out of cgsr-opengl.so beside
/// the program; or why that cannot be had.
Result<std::unique_ptr<render::Expectation>> make_expectation(const world::Map& map,
                                                              const localization::LocalizerParameters& parameters);

}  // namespace cgsr
