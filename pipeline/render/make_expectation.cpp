#include "pipeline/render/make_expectation.h"

#include "pipeline/render/depth_raster.h"
#include "pipeline/render/osmesa_expectation.h"

namespace cgsr::render {

Result<std::unique_ptr<Expectation>> make_expectation(const world::Map& map, const ExpectationParameters& parameters) {
  switch (parameters.kind) {
    case ExpectationKind::kOsmesa: {
      auto made = OsmesaExpectation::make(map, parameters.osmesa);
      if (!made) return tl::make_unexpected(made.error());
      return std::unique_ptr<Expectation>(std::move(*made));
    }
    case ExpectationKind::kRaster:
      break;
  }
  return std::unique_ptr<Expectation>(std::make_unique<DepthRaster>(map, parameters.raster));
}

}  // namespace cgsr::render
