#pragma once

#include <filesystem>

#include "pipeline/color/learn/learn.h"
#include "pipeline/color/track/tracker.h"
#include "platform/error.h"

namespace cgsr::config {

/// The section [color] of a robot's file: chapter 3's own configuration, whose hash every report of chapter 3 prints.
struct Color {
  color::LearnParameters learn;
  color::TrackParameters track;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("learn", self.learn, "Learning an object (Alg. 3.1)");
    visit.section("track", self.track, "Finding the object again (Alg. 3.2 and its extensions)");
  }
};

}  // namespace cgsr::config
