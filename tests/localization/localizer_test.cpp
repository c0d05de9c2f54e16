#include "pipeline/localization/localizer.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/localization/work.h"
#include "tests/localization/random_numbers.h"
#include "tests/localization/small_room.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/counted_budget.h"

namespace cgsr::localization {
namespace {

using geometry::Pose;
using geometry::Vector6d;
using testing::in_small_room;
using testing::MapBuilder;
using testing::Picture;
using testing::RandomNumbers;
using testing::small_room;

constexpr double kDegree = std::numbers::pi / 180.0;

geometry::Camera room_camera() {
  geometry::Camera camera = geometry::Camera{}.scaled_to(320, 240);
  camera.k1 = -0.075;
  camera.k2 = 0.045;
  return camera;
}

struct Error {
  double position_m;
  double direction_deg;
};
Error error_of(const Pose& truth, const Pose& answer) {
  const Vector6d step = geometry::step_between(truth, answer);
  return {step.head<3>().norm(), step.tail<3>().norm() / kDegree};
}

Prior drawn_prior(const Pose& truth, const PriorSigmas& sigmas, RandomNumbers& random) {
  Prior prior = prior_at(truth, sigmas);
  Vector6d off;
  for (int i = 0; i < 6; ++i) off[i] = std::sqrt(prior.covariance(i, i)) * std::clamp(random.normal(), -2.5, 2.5);
  prior.X_WC = geometry::moved(truth, off);
  return prior;
}

// The same image until there is an answer, as a robot that stands.
Correction answer_of(Localizer& localizer, const ImageView& image, const Prior& prior, int& images) {
  UnlimitedBudget budget;
  Correction answer;
  for (images = 1; images < 200; ++images) {
    answer = localizer.correct(image, prior, budget);
    if (answer.reason != Reason::kSearching) break;
  }
  return answer;
}

constexpr PriorSigmas kTracking{.x_m = 0.02, .y_m = 0.02, .z_m = 0.005, .heading_rad = 0.01, .tilt_rad = 0.005};

TEST(Localizer, CorrectsANarrowPriorFromOneImage) {
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  Localizer localizer(map, camera, {});
  RandomNumbers random(11);
  for (int trial = 0; trial < 12; ++trial) {
    const Pose truth = in_small_room(random.uniform(0.8, 1.6), random.uniform(1.2, 2.2), random.uniform(-0.2, 0.7));
    const Picture picture(map, truth, camera, 1.5, static_cast<std::uint32_t>(trial));
    int images = 0;
    const Correction answer = answer_of(localizer, picture.view(), drawn_prior(truth, kTracking, random), images);
    EXPECT_TRUE(answer.corrected) << to_string(answer.reason);
    EXPECT_EQ(images, 1);
    const Error error = error_of(truth, answer.X_WC);
    EXPECT_LT(error.position_m, 0.025);
    EXPECT_LT(error.direction_deg, 0.6);
    EXPECT_GE(answer.matches, 10);
  }
}

/// What no map holds: strips of tape on a wall, all upright.
world::Map wall_of_upright_strips() {
  MapBuilder b;
  const std::uint32_t wall = b.rectangle({2.5F, 8, -4}, {0, -16, 0}, {0, 0, 8}, b.grey(0.2F));
  for (const float left_m : {-0.6F, -0.2F, 0.2F, 0.6F})
    b.rectangle({2.498F, left_m, -3}, {0, -0.04F, 0}, {0, 0, 6}, b.grey(0.8F), wall);
  return b.map;
}

/// Strips of tape on a wall, all level: what is upright of them is too short to be seen.
world::Map wall_of_strips() {
  MapBuilder b;
  const std::uint32_t wall = b.rectangle({2.5F, 8, -4}, {0, -16, 0}, {0, 0, 8}, b.grey(0.2F));
  for (const float height_m : {0.1F, 0.35F, 0.6F, 0.85F}) {
    const float left_m = height_m < 0.5F ? 0.5F : 0.7F;
    b.rectangle({2.498F, left_m, height_m}, {0, -1.1F, 0}, {0, 0, 0.04F}, b.grey(0.8F), wall);
  }
  return b.map;
}

// Matches and stated errors alike: a model a hundredth of a room's size is not half a centimetre off.
TEST(Localizer, StatesASmallModelsErrorByItsSize) {
  MapBuilder model;
  model.rectangle({0, 0, 0}, {0.06F, 0, 0}, {0, 0.08F, 0}, model.grey(0.8F));
  const world::Map room = small_room();
  const auto stated_m = [](const world::Map& map) {
    const Localizer localizer(map, room_camera(), {});
    return std::sqrt(localizer.in_world(geometry::Matrix6d::Zero())(0, 0));
  };
  EXPECT_NEAR(stated_m(model.map), 0.001 * 0.1, 1e-9);
  EXPECT_DOUBLE_EQ(stated_m(room), LocalizerParameters{}.map_sigma_m);
}

// The distances of level lines say nothing of a step to the side; where they end does.
TEST(Localizer, CornersHoldThePoseAlongParallelEdges) {
  const world::Map map = wall_of_strips();
  const geometry::Camera camera = room_camera();
  Localizer localizer(map, camera, {});
  double moved_m = 0.0;
  for (const double off_m : {-0.03, -0.015, 0.015, 0.03}) {
    const Pose truth = in_small_room(0.0, 0.0, 0.0);
    const Picture picture(map, truth, camera, 1.5, 1);
    Prior prior = prior_at(truth, {.x_m = 0.02, .y_m = 0.03, .z_m = 0.005, .heading_rad = 0.001, .tilt_rad = 0.001});
    prior.X_WC.translation().y() += off_m;
    int images = 0;
    const Correction answer = answer_of(localizer, picture.view(), prior, images);
    ASSERT_TRUE(answer.corrected) << to_string(answer.reason);
    EXPECT_LT(std::abs(answer.X_WC.translation().y() - truth.translation().y()), 0.5 * std::abs(off_m));
    EXPECT_LT(std::sqrt(answer.covariance(1, 1)), 0.02);
    moved_m += std::abs(answer.X_WC.translation().y() - prior.X_WC.translation().y());
  }
  EXPECT_GT(moved_m, 0.06);
}

// Too wide for one start, too narrow for a search: a few starts, still in one image. One start alone is caught by the other border of a tape.
TEST(Localizer, CorrectsAPriorOfMiddlingWidthFromOneImage) {
  constexpr PriorSigmas kMiddling{.x_m = 0.03, .y_m = 0.03, .z_m = 0.01, .heading_rad = 0.011, .tilt_rad = 0.005};
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  Localizer localizer(map, camera, {});
  RandomNumbers random(13);
  int corrected = 0;
  constexpr int kTrials = 12;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Pose truth = in_small_room(random.uniform(0.8, 1.6), random.uniform(1.2, 2.2), random.uniform(-0.2, 0.7));
    const Picture picture(map, truth, camera, 1.5, static_cast<std::uint32_t>(trial));
    int images = 0;
    const Correction answer = answer_of(localizer, picture.view(), drawn_prior(truth, kMiddling, random), images);
    EXPECT_EQ(images, 1);
    if (!answer.corrected) continue;
    ++corrected;
    const Error error = error_of(truth, answer.X_WC);
    EXPECT_LT(error.position_m, 0.02);
    EXPECT_LT(error.direction_deg, 0.5);
  }
  EXPECT_GE(corrected, kTrials - 1);
}

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

TEST(Localizer, StrongersMethodWorksWhereNothingIsHidden) {
  testing::MapBuilder b;
  const std::uint32_t floor = b.rectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, b.grey(0.2F));
  const std::uint32_t white = b.grey(0.9F);
  for (int i = 0; i < 4; ++i) {
    b.rectangle({1.0F + 0.6F * static_cast<float>(i), -0.8F, 0.002F}, {0.2F, 0, 0}, {0, 1.7F, 0}, white, floor);
  }
  const Pose truth = in_small_room(-0.2, 0.1, 0.05);
  const Picture picture(b.map, truth, room_camera(), 1.0, 3);
  struct Claim {
    Method method;
    double left;  // of the prior's error, at most
  };
  // The dissertation's own solver takes full steps: here it only must not make it worse.
  for (const auto [method, left] :
       {Claim{Method::kStronger, 0.5}, Claim{Method::kGlCorrect, 0.3}, Claim{Method::kPaper, 1.0}}) {
    RandomNumbers random(13);
    double before_m = 0.0;
    double after_m = 0.0;
    double moved_m = 0.0;
    constexpr int kTrials = 8;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Prior prior = drawn_prior(truth, kTracking, random);
      LocalizerParameters parameters;
      parameters.method = method;
      Localizer localizer(b.map, room_camera(), parameters);
      UnlimitedBudget budget;
      const Correction answer = localizer.correct(picture.view(), prior, budget);
      EXPECT_TRUE(answer.corrected) << static_cast<int>(method) << ", trial " << trial << ": "
                                    << to_string(answer.reason);
      if (trial == 0) {
        EXPECT_LT(error_of(truth, answer.X_WC).position_m, 0.06) << static_cast<int>(method);
      }
      before_m += error_of(truth, prior.X_WC).position_m / kTrials;
      after_m += error_of(truth, answer.X_WC).position_m / kTrials;
      moved_m += error_of(prior.X_WC, answer.X_WC).position_m / kTrials;
    }
    EXPECT_GT(moved_m, 0.0005) << static_cast<int>(method)
                               << ": a method that leaves the prior as it is corrects nothing";
    EXPECT_LT(after_m, left * before_m) << static_cast<int>(method) << ": it was " << before_m << " m off before";
  }
}

class LocalizerFault : public ::testing::Test {
 protected:
  LocalizerFault() : map_(small_room()), camera_(room_camera()), localizer_(map_, camera_, {}) {
    prior_ = prior_at(in_small_room(1.0, 1.6, 0.2), kTracking);
  }
  void expect_untouched(const std::vector<std::uint8_t>& pixels, Reason reason) {
    const ImageView image{
        .data = pixels.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8};
    expect_untouched(image, reason);
  }
  void expect_untouched(const ImageView& image, Reason reason) {
    UnlimitedBudget budget;
    const Correction answer = localizer_.correct(image, prior_, budget);
    EXPECT_FALSE(answer.corrected);
    EXPECT_EQ(answer.reason, reason) << to_string(answer.reason);
    EXPECT_TRUE(answer.X_WC.isApprox(prior_.X_WC, 0.0));
    EXPECT_TRUE(answer.covariance.isApprox(prior_.covariance, 0.0));
  }

  world::Map map_;
  geometry::Camera camera_;
  Localizer localizer_;
  Prior prior_;
};

TEST_F(LocalizerFault, BlackSaturatedAndFeaturelessImagesAreNamed) {
  std::vector<std::uint8_t> pixels(320 * 240, 3);
  expect_untouched(pixels, Reason::kTooDark);
  std::fill(pixels.begin(), pixels.end(), std::uint8_t{255});
  expect_untouched(pixels, Reason::kTooBright);
  std::fill(pixels.begin(), pixels.end(), std::uint8_t{120});
  expect_untouched(pixels, Reason::kTooFewEdges);
}

TEST_F(LocalizerFault, AHandBeforeTheCameraIsNotAPose) {
  Picture picture(map_, prior_.X_WC, camera_, 1.5, 5);
  for (std::size_t y = 0; y < 240; ++y)
    for (std::size_t x = 0; x < 320; ++x)
      if (y > 20 || x > 60) picture.pixels[y * 320 + x] = static_cast<std::uint8_t>(140 + (x + y) / 40);
  UnlimitedBudget budget;
  const Correction answer = localizer_.correct(picture.view(), prior_, budget);
  EXPECT_FALSE(answer.corrected);
  EXPECT_TRUE(answer.reason == Reason::kTooFewEdges || answer.reason == Reason::kUnexplained ||
              answer.reason == Reason::kTooFewMatches)
      << to_string(answer.reason);
  EXPECT_TRUE(answer.X_WC.isApprox(prior_.X_WC, 0.0));
}

TEST_F(LocalizerFault, MotionBlurEitherCorrectsRightlyOrNotAtAll) {
  Picture picture(map_, prior_.X_WC, camera_, 1.5, 6);
  std::vector<std::uint8_t> blurred = picture.pixels;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      int sum = 0;
      for (int k = -25; k <= 25; ++k)
        sum += picture.pixels[static_cast<std::size_t>(y * 320 + std::clamp(x + k, 0, 319))];
      blurred[static_cast<std::size_t>(y * 320 + x)] = static_cast<std::uint8_t>(sum / 51);
    }
  }
  const ImageView image{
      .data = blurred.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8};
  UnlimitedBudget budget;
  const Correction answer = localizer_.correct(image, prior_, budget);
  EXPECT_LT(error_of(prior_.X_WC, answer.X_WC).position_m, 0.03);
  EXPECT_NE(answer.corrected, answer.reason != Reason::kNone);
}

TEST_F(LocalizerFault, AnotherSizeAnotherFormatAndNoImageAreNamed) {
  const std::vector<std::uint8_t> pixels(640 * 480 * 3, 100);
  expect_untouched(
      {.data = pixels.data(), .width_px = 300, .height_px = 240, .stride_bytes = 300, .format = PixelFormat::kGrey8},
      Reason::kWrongSize);
  expect_untouched(
      {.data = pixels.data(), .width_px = 320, .height_px = 240, .stride_bytes = 960, .format = PixelFormat::kBgr24},
      Reason::kWrongSize);
  expect_untouched(ImageView{}, Reason::kWrongSize);
}

TEST_F(LocalizerFault, AMapOfAnotherRoomIsNotBelieved) {
  const Picture picture(map_, in_small_room(1.6, 2.4, 2.2), camera_, 1.5, 7);
  RandomNumbers random(14);
  LocalizerParameters parameters;
  parameters.hypotheses_per_image = 0;
  Localizer localizer(map_, camera_, parameters);
  int images = 0;
  const Correction answer = answer_of(localizer, picture.view(), prior_at(prior_.X_WC, PriorSigmas::floor()), images);
  EXPECT_FALSE(answer.corrected);
}

TEST_F(LocalizerFault, NoBudgetIsNoAnswer) {
  class Nothing final : public WorkBudget {
   public:
    bool grant() override { return false; }
  } nothing;
  const Picture picture(map_, prior_.X_WC, camera_, 1.5, 8);
  const Correction answer = localizer_.correct(picture.view(), prior_, nothing);
  EXPECT_EQ(answer.reason, Reason::kNoBudget);
  EXPECT_TRUE(answer.X_WC.isApprox(prior_.X_WC, 0.0));
}

TEST_F(LocalizerFault, APriorThatIsNoneIsRefused) {
  const Picture picture(map_, prior_.X_WC, camera_, 1.5, 9);
  UnlimitedBudget budget;
  Prior broken = prior_;
  broken.covariance.setZero();
  EXPECT_FALSE(localizer_.correct(picture.view(), broken, budget).corrected);
  broken = prior_;
  broken.X_WC.translation().x() = std::nan("");
  EXPECT_FALSE(localizer_.correct(picture.view(), broken, budget).corrected);
}

TEST(LocalizerEmptyFault, AMapWithoutEdgesIsNamed) {
  const world::Map map;
  Localizer localizer(map, room_camera(), {});
  const std::vector<std::uint8_t> pixels(320 * 240, 100);
  UnlimitedBudget budget;
  const Correction answer = localizer.correct(
      {.data = pixels.data(), .width_px = 320, .height_px = 240, .stride_bytes = 320, .format = PixelFormat::kGrey8},
      prior_at(Pose::Identity(), kTracking), budget);
  EXPECT_EQ(answer.reason, Reason::kNoMap);
}

TEST(LocalizerAlloc, CorrectingAndSearchingAllocateNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "not under a sanitizer";
  const world::Map map = small_room();
  const geometry::Camera camera = room_camera();
  Localizer localizer(map, camera, {});
  const Pose truth = in_small_room(1.0, 1.6, 0.2);
  const Picture picture(map, truth, camera, 1.5, 10);
  UnlimitedBudget budget;
  const Prior narrow = prior_at(truth, kTracking);
  const Prior wide = prior_at(truth, PriorSigmas::floor());
  const test::AllocationGuard guard;
  for (int i = 0; i < 3; ++i) localizer.correct(picture.view(), narrow, budget);
  for (int i = 0; i < 60; ++i) {
    if (localizer.correct(picture.view(), wide, budget).reason != Reason::kSearching) break;
    localizer.carried(Pose::Identity());
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::localization
