#pragma once

#include "pipeline/runtime/schedule.h"

namespace cgsr {

/// The schedule of the vision loop, a row per stage in the order in which it runs them ([stage.*] in a robot's file).
struct VisionStages {
  runtime::StageParameters decode{1, 0, 4000, 0, runtime::OnOverrun::kStopMotion};
  runtime::StageParameters track{1, 0, 12000, 0, runtime::OnOverrun::kSkip};
  runtime::StageParameters decide{1, 0, 1000, 0, runtime::OnOverrun::kStopMotion};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("decode", self.decode, "Camera image to grey and colour labels");
    visit.section("track", self.track, "Where the object is (chapter 3)");
    visit.section("decide", self.decide, "What the robot does about it");
  }
};

}  // namespace cgsr
