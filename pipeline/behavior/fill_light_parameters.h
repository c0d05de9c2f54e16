#pragma once

#include "platform/parameters.h"

namespace cgsr::behavior {

/// When a light on faces is switched. Ours. The line is switches.fill_light_line.
struct FillLightParameters {
  bool enabled = false;
  double min_dark = 0.1;
  double max_waiting_luma = 0.25;
  double no_face_s = 1.0;
  double face_s = 3.0;
  double gone_s = 2.0;
  double max_on_s = 10.0;
  double rest_s = 20.0;
  double fruitless_rest_s = 120.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("enabled", self.enabled,
               "Whether the robot that follows a person lights the face (switches.fill_light_line) where it is dark "
               "and no face is found.");
    visit.number("min_dark", self.min_dark, {0.0, 1.0}, "",
                 "The share of the pixels where the face should be that are too dark for a hue, from which on it is "
                 "dark; of the darkest generated face in good light it is 0.06.");
    visit.number("max_waiting_luma", self.max_waiting_luma, {0.0, 1.0}, "",
                 "The mean brightness of the middle of the image up to which it is dark where nobody is seen by "
                 "anything and a face is waited for; of a hall of light walls in a tenth of good light it is 0.2.");
    visit.number("no_face_s", self.no_face_s, {0.1, 60.0}, "s",
                 "The time without a face in the dark after which the light goes on.");
    visit.number("face_s", self.face_s, {0.1, 60.0}, "s",
                 "The time with a face in view after which the light goes off; seen in the dark without it for as "
                 "long, it is not "
                 "needed.");
    visit.number("gone_s", self.gone_s, {0.1, 60.0}, "s", "The time without anybody after which the light goes off.");
    visit.number("max_on_s", self.max_on_s, {1.0, 600.0}, "s",
                 "The longest time for which the light is on without a break.");
    visit.number(
        "rest_s", self.rest_s, {1.0, 3600.0}, "s",
        "The time for which the light stays off after it showed a face, and where it is not needed after the last face "
        "that was seen without it.");
    visit.number("fruitless_rest_s", self.fruitless_rest_s, {1.0, 3600.0}, "s",
                 "The time for which it stays off after it showed none: dark hair from behind is dark in any light.");
  }
};

}  // namespace cgsr::behavior
