#pragma once

#include "pipeline/color/learn.h"
#include "pipeline/color/tracker.h"

namespace cgsr::lab {

/// The configuration that the tables are measured with: the defaults, which are what ships.
struct Shipped {
  color::LearnParameters learn;
  color::TrackParameters track;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("learn", self.learn, "Alg. 3.1");
    visit.section("track", self.track, "Alg. 3.2");
  }
};

}  // namespace cgsr::lab
