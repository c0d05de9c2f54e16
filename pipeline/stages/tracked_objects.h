#pragma once

#include <array>

#include "pipeline/color/ball/integrated_tracker.h"
#include "pipeline/color/track/object_search.h"
#include "pipeline/color/track/tracker.h"
#include "platform/description.h"

namespace cgsr::stages {

/// One object as its tracker sees it.
struct ObjectTrack {
  color::TrackedObject object;
  color::BallSighting ball;  ///< what the integrated tracker (5.3) says beside that; else nothing.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    const auto& o = self.object;
    visit.flag("found", o.found, "the object was found in this image");
    visit.number("x", when(o.found, o.box.x), {2}, "px", "left edge of its box");
    visit.number("y", when(o.found, o.box.y), {2}, "px", "upper edge of its box");
    visit.number("width", when(o.found, o.box.width), {2}, "px", "width of its box");
    visit.number("height", when(o.found, o.box.height), {2}, "px", "height of its box");
    visit.number("divergence", when(o.found, o.divergence), {5}, "nat", "of the box from the learned histogram");
    visit.number("light_r", when(o.found, o.exact_light.r), {3}, "", "red gain of the light that falls on it");
    visit.number("light_g", when(o.found, o.exact_light.g), {3}, "", "green gain");
    visit.number("light_b", when(o.found, o.exact_light.b), {3}, "", "blue gain");
    visit.number("confidence", when(o.found && o.confidence > 0.0, o.confidence), {3}, "",
                 "probability that the box covers the object");
  }
};

/// The objects that are tracked, in the order in which they were configured.
struct TrackedObjects {
  static constexpr int kMaxObjects = 4;

  int count = 0;
  std::array<ObjectTrack, kMaxObjects> tracks{};
  color::SearchSize next_search;  ///< the window size with which the next image is to be searched.

  /// The first object, or one that is not found where there is none.
  [[nodiscard]] const ObjectTrack& first() const { return tracks.front(); }

  /// The fields of the first object.
  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    ObjectTrack::describe(self.tracks.front(), visit);
  }
};

}  // namespace cgsr::stages
