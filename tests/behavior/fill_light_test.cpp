#include "pipeline/behavior/fill_light.h"

#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::behavior {
namespace {

constexpr Duration kImage = seconds(0.1);
constexpr FaceEvidence kNobody{};
constexpr FaceEvidence kFacelessInTheDark{true, false, 0.8};
constexpr FaceEvidence kFacelessInTheLight{true, false, 0.05};
constexpr FaceEvidence kFaceInTheDark{true, true, 0.8};
constexpr FaceEvidence kFace{true, true, 0.0};
constexpr FaceEvidence kLost{true, false, 0.8, true};

/// So long there is this to be seen; at its end the light is on or off, by this reason if it changed in the meantime.
struct Step {
  double for_s = 0.0;
  FaceEvidence evidence;
  bool on = false;
  std::string reason;
};

struct Case {
  std::string name;
  std::vector<Step> steps;
};

const std::string kDark = "no face where one should be, and it is dark", kSeen = "a face was seen long enough",
                  kLong = "it was on for long enough", kGone = "nobody is there", kNeeded = "nobody is seen without it";

// As shipped: on after 1 s; off after 3 s with a face, 2 s with nobody, 10 s at most; 20 s of rest, 120 s where it showed no face.
const std::vector<Case> kCases = {
    {"on after a second", {{0.9, kFacelessInTheDark, false, ""}, {0.2, kFacelessInTheDark, true, kDark}}},
    {"not where it is light", {{30.0, kFacelessInTheLight, false, ""}}},
    {"not where a face is seen", {{30.0, kFaceInTheDark, false, ""}}},
    {"not for who turns away after his face was seen in the dark",
     {{3.2, kFaceInTheDark, false, ""}, {20.5, kFacelessInTheDark, false, ""}, {1.0, kFacelessInTheDark, true, kDark}}},
    {"for whoever comes after who was seen without it has left",
     {{3.2, kFaceInTheDark, false, ""}, {2.8, kLost, false, ""}, {0.5, kLost, true, kDark}}},
    {"not held for who is seen without it",
     {{1.1, kLost, true, kDark},
      {3.2, kFace, false, kSeen},
      {3.1, kFaceInTheDark, false, ""},
      {0.5, kLost, false, ""}}},
    {"where a face was met in the dark once, for who shows none",
     {{0.5, kFaceInTheDark, false, ""}, {1.2, kFacelessInTheDark, true, kDark}}},
    {"for who turns away after his face was seen in good light",
     {{9.0, kFace, false, ""}, {1.2, kFacelessInTheDark, true, kDark}}},
    {"not where nobody is", {{30.0, kNobody, false, ""}}},
    {"a face begins the second anew",
     {{0.8, kFacelessInTheDark, false, ""}, {0.1, kFaceInTheDark, false, ""}, {0.8, kFacelessInTheDark, false, ""}}},
    {"a lit face is seen",
     {{1.1, kFacelessInTheDark, true, kDark}, {2.8, kFace, true, ""}, {0.4, kFace, false, kSeen}}},
    {"a face with gaps counts together",
     {{1.1, kFacelessInTheDark, true, kDark},
      {2.0, kFace, true, ""},
      {1.0, kFacelessInTheLight, true, ""},
      {1.2, kFace, false, kSeen}}},
    {"no face in the light either",
     {{1.1, kFacelessInTheDark, true, kDark}, {10.1, kFacelessInTheLight, false, kLong}}},
    {"nobody is left",
     {{1.1, kFacelessInTheDark, true, kDark}, {1.8, kNobody, true, ""}, {0.4, kNobody, false, kGone}}},
    {"it rests",
     {{1.1, kFacelessInTheDark, true, kDark},
      {3.2, kFace, false, kSeen},
      {19.5, kFacelessInTheDark, false, ""},
      {1.0, kFacelessInTheDark, true, kDark}}},
    {"it is held where nobody is seen without it",
     {{1.1, kLost, true, kDark},
      {3.2, kFace, false, kSeen},
      {0.2, kLost, false, ""},
      {0.2, kLost, true, kNeeded},
      {9.0, kFace, true, ""},
      {1.0, kFace, false, kLong},
      {0.5, kLost, true, kNeeded}}},
    {"whom it showed has left",
     {{1.1, kLost, true, kDark}, {1.0, kFace, true, ""}, {1.8, kLost, true, ""}, {0.3, kLost, false, kGone}}},
    {"it is not held where it is light",
     {{1.1, kLost, true, kDark}, {3.2, kFace, false, kSeen}, {10.0, {true, false, 0.0, true}, false, ""}}},
    {"it is not held for somebody who leaves later",
     {{1.1, kLost, true, kDark},
      {3.2, kFace, false, kSeen},
      {5.0, kFacelessInTheDark, false, ""},
      {9.0, kLost, false, ""}}},
    {"it rests longer where it was of no use",
     {{1.1, kFacelessInTheDark, true, kDark},
      {10.1, kFacelessInTheDark, false, kLong},
      {119.0, kFacelessInTheDark, false, ""},
      {1.5, kFacelessInTheDark, true, kDark}}},
};

TEST(FillLight, TurnsOnAndOffAsTheTableSays) {
  for (const Case& one : kCases) {
    FillLight light{FillLightParameters{}};
    for (std::size_t i = 0; i < one.steps.size(); ++i) {
      const Step& step = one.steps[i];
      std::string reason;
      FillLightDecision last;
      for (int image = 0; image < static_cast<int>(step.for_s / to_seconds(kImage) + 0.5); ++image) {
        last = light.decide(step.evidence, kImage);
        if (last.changed) reason = last.reason;
      }
      EXPECT_EQ(last.on, step.on) << one.name << ", step " << i;
      EXPECT_EQ(reason, step.reason) << one.name << ", step " << i;
    }
  }
}

// Whatever is seen, also where the light itself decides what is seen: between two times on there is the rest, and no time on is longer than the maximum.
TEST(FillLight, NeverFlickers) {
  std::mt19937 random(7);
  const FillLightParameters parameters;
  for (int trial = 0; trial < 50; ++trial) {
    FillLight light(parameters);
    double off_s = 0.0, on_s = 0.0;
    bool on = false, was_on = false;
    int changes = 0;
    for (int image = 0; image < 6000; ++image) {
      const bool shows = trial % 4 == 1 && image / 400 % 2 == 0;  // a face, now and then, without the light too
      FaceEvidence evidence{random() % 32 != 0, random() % 4 == 0 && (shows || on), double(random() % 100) / 100.0};
      if (trial % 2 == 0) evidence = {true, on, on ? 0.0 : 1.0};
      const FillLightDecision decision = light.decide(evidence, kImage);
      EXPECT_EQ(decision.changed, decision.on != on);
      if (decision.changed && decision.on && was_on) {
        EXPECT_GE(off_s, parameters.rest_s - 0.2);
      }
      changes += decision.changed ? 1 : 0;
      on = decision.on;
      was_on = was_on || on;
      on_s = on ? on_s + to_seconds(kImage) : 0.0;
      off_s = on ? 0.0 : off_s + to_seconds(kImage);
      ASSERT_LE(on_s, parameters.max_on_s + 0.2);
    }
    { EXPECT_GT(changes, 8) << "it goes on again after each rest"; }
  }
}

// Whom it showed has left a dark room for good: it is held on once more, for whoever is not seen without it, and then it rests.
TEST(FillLight, ComesToRestInAnEmptyRoom) {
  FillLight light{FillLightParameters{}};
  int changes = 0;
  bool on = false;
  const auto see = [&](const FaceEvidence& evidence, double for_s) {
    for (int image = 0; image < static_cast<int>(for_s / to_seconds(kImage) + 0.5); ++image) {
      const FillLightDecision decision = light.decide(evidence, kImage);
      changes += decision.changed ? 1 : 0;
      on = decision.on;
    }
  };
  see(kLost, 1.5);
  see(kFace, 1.0);
  ASSERT_TRUE(on);
  see(kLost, 60.0);
  EXPECT_EQ(changes, 4) << "on, off, held on, off";
  EXPECT_FALSE(on);
}

TEST(FillLight, TakesATimeThatRunsBackwardsForNone) {
  FillLight light{FillLightParameters{}};
  for (int image = 0; image < 100; ++image) EXPECT_FALSE(light.decide(kFacelessInTheDark, seconds(-1.0)).on);
}

}  // namespace
}  // namespace cgsr::behavior
