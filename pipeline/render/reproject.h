#pragma once

#include <span>
#include <vector>

#include "pipeline/render/expectation.h"
#include "platform/parameters.h"

namespace cgsr::render {

/// When pieces that are known to be visible are no longer taken for what is visible.
struct KeepParameters {
  double moved_m = 0.05;
  double turned_deg = 3.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("moved_m", self.moved_m, {0.0, 10.0}, "m",
                 "a camera that moved further looks anew at what is visible");
    visit.number("turned_deg", self.turned_deg, {0.0, 180.0}, "deg", "likewise for a camera that turned");
  }
};

/// \return whether a camera that looked from `drawn` is too far from there now.
bool look_again(const geometry::Pose& drawn, const geometry::Pose& now, const KeepParameters& parameters);

/// The same pieces of edges as they would appear from another pose, occlusion unchanged. What leaves the view is cut or left out.
///
/// \param known  of any earlier look.  \param pieces  cleared and filled in the order of `known`, never beyond its capacity; not `known`.
/// \param near_m  > 0.  Cost: about 150 instructions a piece.
void reproject(const world::Map& map, const geometry::Pose& X_WC, const geometry::Camera& camera,
               std::span<const VisiblePiece> known, std::vector<VisiblePiece>& pieces, double near_m = 0.05);

}  // namespace cgsr::render
