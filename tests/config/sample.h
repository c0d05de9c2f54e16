#pragma once

#include <array>
#include <string>

#include "platform/parameters.h"

namespace cgsr::config {

enum class Overrun { kSkip, kStopMotion };
inline constexpr std::array<Named<Overrun>, 2> kOverrunWords{
    {{"skip", Overrun::kSkip}, {"stop_motion", Overrun::kStopMotion}}};

struct SampleStage {
  int every_frames = 1;
  int budget_us = 7000;
  Overrun on_overrun = Overrun::kSkip;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("every_frames", self.every_frames, {1, 30}, "", "Runs in every n-th frame.");
    visit.number("budget_us", self.budget_us, {100, 33000}, "µs", "The time it may take.");
    visit.choice("on_overrun", self.on_overrun, kOverrunWords, "What happens when it takes longer.");
  }
};

struct SampleStages {
  SampleStage decode;
  SampleStage track;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("decode", self.decode, "Decoding");
    visit.section("track", self.track, "Tracking");
  }
};

struct SampleArea {
  double from_m = -1.0;
  double to_m = 1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("from_m", self.from_m, {-10.0, 10.0}, "m", "The left end.");
    visit.number("to_m", self.to_m, {-10.0, 10.0}, "m", "The right end.");
  }
  [[nodiscard]] std::string inconsistency() const { return from_m < to_m ? "" : "from_m must be below to_m"; }
};

/// One field of every kind.
struct Sample {
  std::string name = "home";
  bool armed = false;
  SampleArea area;
  SampleStages stage;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("name", self.name, "What the robot is called | for people.");
    visit.flag("armed", self.armed, "Whether it starts armed.");
    visit.section("area", self.area, "Where it may go");
    visit.section("stage", self.stage, "The schedule");
  }
};

inline constexpr std::string_view kWholeSample = R"(name = "lab"
armed = true
[area]
from_m = -2
to_m = 2.5
[stage.decode]
every_frames = 1
budget_us    = 1500
on_overrun   = "stop_motion"
[stage.track]          # chapter 3
every_frames = 2
budget_us    = 7_000
on_overrun   = "skip"
)";

}  // namespace cgsr::config
