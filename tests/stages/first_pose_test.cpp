// A robot that nobody tells where it is: the localize stage asks it to turn on the spot, and its task waits.
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/runtime/stage_budget.h"
#include "pipeline/stages/decide_stage.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/localize_stage.h"
#include "pipeline/stages/tasks.h"
#include "platform/work_budget.h"
#include "tests/localization/small_room.h"

namespace cgsr::stages {
namespace {

using geometry::Pose;
using global_localization::Phase;
using localization::testing::in_small_room;
using localization::testing::leaning;
using localization::testing::Picture;
using localization::testing::small_room;

constexpr std::size_t kPixels = 320 * 240;
constexpr double kImage_s = 0.25;
constexpr double kTurn_radps = 0.7;

/// Drives straight on as soon as it is asked.
class GoesAhead final : public Task {
 public:
  Decision decide(const FrameResult&, const ImageView&, Duration) override {
    Decision decision;
    decision.goal.forward_mps = 0.3;
    decision.state = "ahead";
    return decision;
  }
};

class SeeksFirstPose : public ::testing::Test {
 protected:
  SeeksFirstPose() {
    LocalizationSetup setup;
    setup.map = map_;
    setup.camera = camera_;
    setup.X_RC = X_RC_;
    setup.first_turn_radps = kTurn_radps;
    for (double x_m = 0.5; x_m < 3.0; x_m += 0.4) {
      for (double y_m = 0.5; y_m < 3.6; y_m += 0.4) setup.start_places_m.emplace_back(x_m, y_m);
    }
    localize_ = std::make_unique<LocalizeStage>(std::move(setup));
  }

  /// One image from where the robot is, black in the dark; then the robot does what was decided.
  const Decision& step(bool dark = false) {
    ++images_;
    const double pitch_rad = lean_rad_ * (images_ % 3 - 1);
    std::vector<std::uint8_t> yuyv(2 * kPixels, 2);
    if (!dark) {
      const Picture picture(*map_, X_WR_ * leaning(pitch_rad, LocalizationSetup{}.axle_height_m) * X_RC_, camera_, 1.5,
                            static_cast<std::uint32_t>(images_));
      for (std::size_t i = 0; i < kPixels; ++i) yuyv[2 * i] = picture.pixels[i];
    }
    for (std::size_t i = 0; i < kPixels; ++i) yuyv[2 * i + 1] = 128;
    const ImageView image{.data = yuyv.data(),
                          .width_px = camera_.width_px,
                          .height_px = camera_.height_px,
                          .stride_bytes = 2 * camera_.width_px,
                          .format = PixelFormat::kYuyv};
    frame_.view = {decode_.update(image), {}, Duration::zero()};
    auto budget = runtime::StageBudget::of_units(units_);
    hal::Odometry odometry;  // it began elsewhere
    odometry.x_m = 5.0;
    odometry.heading_rad = turned_rad_ + 1.0;
    odometry.pitch_rad = pitch_rad;
    frame_.pose = {localize_->update(budget, image, frame_.view, odometry), {}, Duration::zero()};
    for (const Event& event : frame_.pose.value.events) {
      if (event.source == "first pose") phases_.emplace_back(event.state);
    }
    frame_.decision = {decide_.update(ImageLease(), frame_), {}, Duration::zero()};
    const Decision& decision = frame_.decision.value;
    turned_rad_ += kImage_s * decision.goal.left_radps;
    X_WR_ = X_WR_ * geometry::pose_on_floor(0.0, 0.0, kImage_s * decision.goal.left_radps);
    return decision;
  }

  std::shared_ptr<const world::Map> map_ = std::make_shared<world::Map>(small_room());
  geometry::Camera camera_ = geometry::Camera{}.scaled_to(320, 240);
  Pose X_RC_ = in_small_room(0.0, 0.0, 0.0);
  DecodeStage decode_{DecodeStage::Setup{320, 240, {}}};
  DecideStage decide_{std::make_unique<GoesAhead>()};
  std::unique_ptr<LocalizeStage> localize_;
  FrameResult frame_;
  Pose X_WR_ = geometry::pose_on_floor(2.2, 2.1, -2.0);
  double turned_rad_ = 0.0;
  double lean_rad_ = 0.0;  ///< to and fro from image to image.
  std::uint32_t units_ = runtime::StageBudget::kAll;
  int images_ = 0;
  std::vector<std::string> phases_;
};

TEST_F(SeeksFirstPose, TurnsUntilItKnowsAndLetsItsTaskDriveThen) {
  while (step().state == "seek_first_pose" && images_ < 400) {
    EXPECT_EQ(frame_.decision.value.goal.forward_mps, 0.0);
    EXPECT_FALSE(frame_.pose.value.known()) << "nobody drives by it";
    EXPECT_EQ(frame_.pose.value.state(), to_string(frame_.pose.value.first_pose));
  }
  EXPECT_EQ(frame_.decision.value.state, "ahead");
  EXPECT_EQ(phases_, (std::vector<std::string>{"comparing", "trying", "settling", "found"}));
  EXPECT_GT(turned_rad_, 2.0 * std::numbers::pi);
  const behavior::PlanarPose& robot = frame_.pose.value.robot;
  EXPECT_TRUE(frame_.pose.value.known());
  EXPECT_LT(std::hypot(robot.x_m - 2.2, robot.y_m - 2.1), 0.03);
  for (int i = 0; i < 5; ++i) step();
  EXPECT_EQ(frame_.pose.value.state(), "tracking") << "from there on the pose is carried on";
}

// What it looks at of the turn does not move with the robot of now, although the localizer searches for many images.
TEST_F(SeeksFirstPose, FindsItWhileItBalances) {
  lean_rad_ = 1.0 / 57.3;
  units_ = 18;
  while (step().state == "seek_first_pose" && images_ < 600) {
  }
  EXPECT_LT(images_, 300) << "views are lost: they move along with the robot";
  EXPECT_EQ(phases_, (std::vector<std::string>{"comparing", "trying", "settling", "found"}));
  EXPECT_LT(std::hypot(frame_.pose.value.robot.x_m - 2.2, frame_.pose.value.robot.y_m - 2.1), 0.04);
}

TEST_F(SeeksFirstPose, GivesUpAndStandsAfterSomeTurnsInTheDark) {
  while (phases_.size() < 20 && images_ < 600) step(true);
  EXPECT_EQ(std::multiset<std::string>(phases_.begin(), phases_.end()).count("not_found"),
            static_cast<std::size_t>(LocalizeStage::kFirstTurns));
  EXPECT_EQ(frame_.decision.value.goal.left_radps, 0.0);
  EXPECT_EQ(frame_.decision.value.state, "seek_first_pose") << "its task does not drive";
  EXPECT_LT(turned_rad_, 2.5 * std::numbers::pi * LocalizeStage::kFirstTurns);
}

// Where the pose stage is late the robot stops.
TEST_F(SeeksFirstPose, StandsWhileTheSearchIsNotHeardOf) {
  step();
  ASSERT_GT(step().goal.left_radps, 0.0);
  frame_.pose.age = kMaxPoseAge + Duration(1);
  const Decision decision = decide_.update(ImageLease(), frame_);
  EXPECT_EQ(decision.goal.left_radps, 0.0);
  EXPECT_EQ(decision.state, "seek_first_pose");
}

// Nor does its task drive because of an image that could not be reduced.
TEST_F(SeeksFirstPose, GoesOnAfterAnImageWithoutAView) {
  step();
  UnlimitedBudget whole;
  frame_.view = {};
  frame_.pose = {localize_->update(whole, {}, frame_.view, hal::Odometry{}), {}, Duration::zero()};
  EXPECT_EQ(decide_.update(ImageLease(), frame_).state, "seek_first_pose");
}

}  // namespace
}  // namespace cgsr::stages
