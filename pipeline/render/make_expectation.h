#pragma once

#include <memory>

#include "pipeline/render/expectation.h"
#include "pipeline/render/osmesa_parameters.h"
#include "pipeline/render/raster_parameters.h"
#include "platform/error.h"
#include "platform/parameters.h"

namespace cgsr::render {

enum class ExpectationKind : std::uint8_t { kRaster, kOsmesa };

inline constexpr Named<ExpectationKind> kExpectationKindNames[] = {{"raster", ExpectationKind::kRaster},
                                                                   {"osmesa", ExpectationKind::kOsmesa}};

/// What draws the edges that should be visible.
struct ExpectationParameters {
  ExpectationKind kind = ExpectationKind::kRaster;
  RasterParameters raster;
  OsmesaParameters osmesa;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("kind", self.kind, kExpectationKindNames, "our own depth buffer, or OpenGL through OSMesa");
    visit.section("raster", self.raster, "our own depth buffer");
    visit.section("osmesa", self.osmesa, "OpenGL");
  }
};

/// \param map  outlives it.  \return an error only where OpenGL is wanted and cannot be had.
Result<std::unique_ptr<Expectation>> make_expectation(const world::Map& map, const ExpectationParameters& parameters);

}  // namespace cgsr::render
