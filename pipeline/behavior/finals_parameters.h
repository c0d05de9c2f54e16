#pragma once

#include "platform/parameters.h"

namespace cgsr::behavior {

/// When the robot of the Finals speaks (6.4.3). Ours: the dissertation does not say when it was sure.
struct FinalsParameters {
  int images_to_be_sure = 3;
  int images_of_shirt = 8;
  double max_same_shirt = 0.06;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("images_to_be_sure", self.images_to_be_sure, {1, 100}, "",
                 "A face has to be the person's, or a stranger's, in so many images in a row in which it is looked for "
                 "before it is spoken of; a stranger's that is lost after two of them is above the shirt still.");
    visit.number("images_of_shirt", self.images_of_shirt, {1, 1000}, "",
                 "Whether the shirt has changed is said when it was seen below the face in so many images.");
    visit.number("max_same_shirt", self.max_same_shirt, {0.0, 1.0}, "",
                 "The largest distance between the chromaticities r and g of one shirt, seen twice.");
  }
};

}  // namespace cgsr::behavior
