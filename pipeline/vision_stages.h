#pragma once

#include "pipeline/runtime/schedule.h"

namespace cgsr {

/// The schedule of the vision loop, a row per stage in the order in which it runs them ([stage.*] in a robot's file).
struct VisionStages {
  runtime::StageParameters decode{1, 0, 3000, 0, runtime::OnOverrun::kStopMotion};
  runtime::StageParameters localize{1, 0, 9000, 0, runtime::OnOverrun::kSkip};
  runtime::StageParameters probes{2, 0, 3000, 0, runtime::OnOverrun::kSkip};
  runtime::StageParameters shade{2, 1, 7000, 0, runtime::OnOverrun::kSkip};
  runtime::StageParameters search{1, 0, 7500, 0, runtime::OnOverrun::kSkip};
  runtime::StageParameters track{1, 0, 5500, 0, runtime::OnOverrun::kSkip};
  runtime::StageParameters decide{1, 0, 1000, 0, runtime::OnOverrun::kStopMotion};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("decode", self.decode, "Camera image to grey and colour labels");
    visit.section("localize", self.localize, "Where the robot is: the pose corrected against the map (chapter 4)");
    visit.section("probes", self.probes,
                  "Where the lamp is: the probes' shadows, one image's lamp, the lamps of the world (Alg. 5.1)");
    visit.section("shade", self.shade, "What lies in its shadow: the masks, from map, pose and lamp (5.2)");
    visit.section("search", self.search, "Windows that look like the object, in the whole image (Alg. 3.2)");
    visit.section("track", self.track, "Which of them it is, and the box that fits");
    visit.section("decide", self.decide, "What the robot does about it");
  }
};

}  // namespace cgsr
