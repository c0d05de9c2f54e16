#pragma once

#include <string>

#include "pipeline/behavior/fill_light_parameters.h"
#include "pipeline/person/tracking/identifier.h"

namespace cgsr::config {

/// The section [person] of a robot's file (chapter 6).
struct Person {
  std::string identities;
  std::string cascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml";
  std::string eye_cascade = "/usr/share/opencv4/haarcascades/haarcascade_eye.xml";
  person::IdentifierParameters identifier;
  behavior::FillLightParameters fill_light;

  [[nodiscard]] bool enabled() const { return knows_faces() || identifier.marker.enabled; }
  [[nodiscard]] bool knows_faces() const { return !identities.empty(); }

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.path("identities", self.identities,
               "The people who are known: a file written by cgsr people enroll. Without one the robot identifies "
               "nobody, unless "
               "by a marker.");
    visit.path("cascade", self.cascade, "The cascade that finds frontal faces, of Debian's package opencv-data.");
    visit.path(
        "eye_cascade", self.eye_cascade,
        "The cascade that finds eyes, of the same package: what has none is no stranger's face. Empty: eyes are not "
        "looked for, and what has none may be a stranger's face.");
    person::IdentifierParameters::describe(self.identifier, visit);
    visit.section("fill_light", self.fill_light, "A light on faces in the dark (6.4.1.1)");
  }
};

}  // namespace cgsr::config
