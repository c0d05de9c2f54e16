#include "pipeline/localization/localizer.h"

#include <gtest/gtest.h>

#include "pipeline/localization/work.h"
#include "tests/localization/localizer_cases.h"

namespace cgsr::localization {
namespace {

using geometry::Pose;
using geometry::Vector6d;
using testing::answer_of;
using testing::drawn_prior;
using testing::Error;
using testing::error_of;
using testing::in_small_room;
using testing::kDegree;
using testing::Picture;
using testing::RandomNumbers;
using testing::room_camera;
using testing::small_room;
using testing::wall_of_strips;
using testing::wall_of_upright_strips;

TEST(Localizer, FindsThePoseInAWidePrior) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  LocalizerParameters parameters;
  parameters.hypotheses_per_image = 0;
  Localizer localizer(map, camera, parameters);
  RandomNumbers random(12);
  int corrected = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const Pose truth = in_small_room(random.uniform(0.8, 1.6), random.uniform(1.2, 2.2), random.uniform(-0.2, 0.7));
    const Picture picture(map, truth, camera, 1.5, static_cast<std::uint32_t>(trial));
    int images = 0;
    const Correction answer =
        answer_of(localizer, picture.view(), drawn_prior(truth, PriorSigmas::floor(), random), images);
    if (!answer.corrected) continue;
    ++corrected;
    const Error error = error_of(truth, answer.X_WC);
    EXPECT_LT(error.position_m, 0.02);
    EXPECT_LT(error.direction_deg, 0.5);
  }
  EXPECT_GE(corrected, 5);
}

// The map is there to be expected: an image that matches none of it is a failure of the search, which a tracker counts.
TEST(Localizer, ASearchThatFindsNoMatchesSaysSo) {
  const world::Map map = wall_of_strips();
  const Pose truth = in_small_room(0.0, 0.0, 0.0);
  const Picture picture(wall_of_upright_strips(), truth, room_camera(), 1.5, 1);
  for (const double scale : {0.3, 1.0}) {
    Localizer localizer(map, room_camera(), {});
    int images = 0;
    const Correction answer =
        answer_of(localizer, picture.view(), prior_at(truth, PriorSigmas::floor().times(scale)), images);
    EXPECT_EQ(answer.reason, Reason::kTooFewMatches) << scale << ": " << to_string(answer.reason);
    EXPECT_GE(answer.segments, 4);
  }
}

// From beside the strips a wide prior's other starts see them: what stands before the bare wall, and in no map, is no failure.
TEST(Localizer, ASearchBeforeABareWallExpectsNothing) {
  const world::Map map = wall_of_strips();
  const Picture picture(wall_of_upright_strips(), in_small_room(0.0, 0.0, 0.0), room_camera(), 1.5, 1);
  for (const double left_m : {2.1, 2.2}) {
    const Prior prior = prior_at(in_small_room(0.0, left_m, 0.0), PriorSigmas::floor().times(4.0));
    Localizer localizer(map, room_camera(), {});
    int images = 0;
    const Correction answer = answer_of(localizer, picture.view(), prior, images);
    EXPECT_EQ(answer.reason, Reason::kNothingExpected) << left_m << ": " << to_string(answer.reason);
    EXPECT_GE(answer.segments, 4);
  }
}

// A pose is claimed for the image of the answer, however much earlier ones said for it.
TEST(Localizer, ASearchClaimsNothingForAnImageThatDoesNotShowIt) {
  const world::Map map = small_room();
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture shown(map, truth, room_camera(), 1.5, 4);
  const Picture other(map, in_small_room(1.6, 2.4, 2.2), room_camera(), 1.5, 4);
  const PriorSigmas middling{.x_m = 0.02, .y_m = 0.02, .z_m = 0.005, .heading_rad = 0.015, .tilt_rad = 0.004};
  struct Result {
    Correction answer;
    int images;
  };
  for (const PriorSigmas& sigmas : {middling, PriorSigmas::floor()}) {
    const auto search = [&](int images_shown) {
      Localizer localizer(map, room_camera(), {});
      Result result{{.reason = Reason::kSearching}, 0};
      for (; result.answer.reason == Reason::kSearching && result.images < 1000; ++result.images) {
        CountedBudget budget(14);
        const Picture& picture = result.images < images_shown ? shown : other;
        result.answer = localizer.correct(picture.view(), prior_at(truth, sigmas), budget);
      }
      return result;
    };
    const Result whole = search(1000);
    ASSERT_TRUE(whole.answer.corrected) << to_string(whole.answer.reason);
    for (int last = 1; last <= 4; ++last) {
      const Result changed = search(whole.images - last);
      EXPECT_FALSE(changed.answer.corrected) << last << " of " << whole.images << " images show something else";
    }
  }
}

// Eight starts an image: the search goes on over several, and hypotheses move with the camera.
TEST(Localizer, SearchesOverImagesOfAMovingCamera) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  Localizer localizer(map, camera, {});
  Pose truth = in_small_room(1.0, 1.6, 0.2);
  Pose believed = geometry::moved(truth, (Vector6d() << 0.12, -0.1, 0.0, 0.0, 0.0, 4.0 * kDegree).finished());
  const Pose X_RC = in_small_room(0.0, 0.0, 0.0);
  const Pose X_C0C1 = X_RC.inverse() * geometry::pose_on_floor(0.004, 0.0, 0.002) * X_RC;
  UnlimitedBudget budget;
  Correction answer;
  int images = 0;
  for (; images < 60; ++images) {
    const Picture picture(map, truth, camera, 1.5, static_cast<std::uint32_t>(images));
    answer = localizer.correct(picture.view(), prior_at(believed, PriorSigmas::floor()), budget);
    if (answer.reason != Reason::kSearching) break;
    EXPECT_TRUE(localizer.searching());
    EXPECT_LE(answer.looks, 40);
    truth = truth * X_C0C1;
    believed = believed * X_C0C1;
    localizer.carried(X_C0C1);
  }
  EXPECT_TRUE(answer.corrected) << to_string(answer.reason);
  EXPECT_GT(images, 3);
  EXPECT_LT(error_of(truth, answer.X_WC).position_m, 0.02);
}

// Whatever the search still has to do, an image's looks at the map are bounded by what it is granted.
TEST(LocalizerProperty, AnImageLooksNoMoreOftenThanItIsGranted) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture picture(map, truth, camera, 1.5, 1);
  for (const int units : {1, 3, 8, 20, 60}) {
    for (const double scale : {0.3, 1.0, 3.0}) {
      LocalizerParameters parameters;
      parameters.hypotheses_per_image = 0;
      Localizer localizer(map, camera, parameters);
      for (int image = 0; image < 30; ++image) {
        CountedBudget budget(units);
        const Correction answer =
            localizer.correct(picture.view(), prior_at(truth, PriorSigmas::floor().times(scale)), budget);
        EXPECT_LE(answer.looks * kLookUnits, units);
      }
    }
  }
}

// What is visible is drawn anew only when the camera has moved; until then the known edges are projected.
TEST(Localizer, AStandingCameraLooksOnce) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  Localizer localizer(map, camera, {});
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  constexpr PriorSigmas kFollowed{.x_m = 0.008, .y_m = 0.008, .z_m = 0.003, .heading_rad = 0.004, .tilt_rad = 0.002};
  UnlimitedBudget budget;
  const auto looks_at = [&](const Pose& X_WC, std::uint32_t seed) {
    const Picture picture(map, X_WC, camera, 1.5, seed);
    const Correction answer = localizer.correct(picture.view(), prior_at(X_WC, kFollowed), budget);
    EXPECT_TRUE(answer.corrected) << to_string(answer.reason);
    EXPECT_LT(error_of(X_WC, answer.X_WC).position_m, 0.02);
    return answer.looks;
  };
  EXPECT_GE(looks_at(truth, 1), 1);
  int looks = 0;
  for (std::uint32_t seed = 2; seed < 8; ++seed) looks += looks_at(truth, seed);
  EXPECT_EQ(looks, 0);
  const Pose turned = in_small_room(1.0, 1.6, 0.3);
  EXPECT_GE(looks_at(turned, 9), 1);
}

// Without its alternative hypotheses a pose is not known to be the only one: what an image's budget does not hold is searched over several.
TEST(Localizer, APriorThatNeedsMoreStartsThanTheBudgetHoldsIsSearchedOverImages) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture picture(map, truth, camera, 1.5, 4);
  const PriorSigmas wider{.x_m = 0.02, .y_m = 0.02, .z_m = 0.005, .heading_rad = 0.015, .tilt_rad = 0.004};
  for (const int units : {kLookUnits + kRoundUnits, 20, 1000}) {
    Localizer localizer(map, camera, {});
    Correction answer{.reason = Reason::kSearching};
    int images = 0;
    for (; answer.reason == Reason::kSearching && images < 100; ++images) {
      CountedBudget budget(units);
      answer = localizer.correct(picture.view(), prior_at(truth, wider), budget);
    }
    EXPECT_EQ(answer.reason, Reason::kNone) << units;
    EXPECT_LT(error_of(truth, answer.X_WC).position_m, 0.02) << units;
    if (units < 1000) {
      EXPECT_GT(images, 3);
    } else {
      EXPECT_EQ(images, 1);
    }
  }
}

// An image that is granted nothing says so, and leaves what is under way as it is.
TEST(Localizer, AnImageWithoutWorkIsNotCorrectedForWantOfBudget) {
  const world::Map map = small_room();
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture picture(map, truth, room_camera(), 1.5, 1);
  for (const double scale : {0.05, 1.0}) {
    Localizer localizer(map, room_camera(), {});
    const Prior prior = prior_at(truth, PriorSigmas::floor().times(scale));
    const auto reason_with = [&](int units) {
      CountedBudget budget(units);
      return localizer.correct(picture.view(), prior, budget).reason;
    };
    EXPECT_EQ(reason_with(0), Reason::kNoBudget) << scale;
    EXPECT_EQ(reason_with(kLookUnits - 1), Reason::kNoBudget) << scale << ": not even the first look";
    EXPECT_NE(reason_with(kMinSearchUnits + kLookUnits), Reason::kNoBudget) << scale;
    EXPECT_EQ(reason_with(0), Reason::kNoBudget) << scale << ", under way";
  }
}

// However little an image is granted, a search comes to its end: from kMinSearchUnits on.
TEST(LocalizerProperty, ASearchEndsWhateverItIsGranted) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture picture(map, truth, camera, 1.5, 1);
  for (const int units : {kMinSearchUnits, kMinSearchUnits + 1, 24}) {
    Localizer localizer(map, camera, {});
    int images = 0;
    Reason reason = Reason::kSearching;
    for (; reason == Reason::kSearching && images < 4000; ++images) {
      CountedBudget budget(units);
      reason = localizer.correct(picture.view(), prior_at(truth, PriorSigmas::floor()), budget).reason;
    }
    EXPECT_NE(reason, Reason::kSearching) << units;
  }
}

}  // namespace
}  // namespace cgsr::localization
