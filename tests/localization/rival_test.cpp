#include "pipeline/localization/rival.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/localization/pose_tracker.h"
#include "tests/localization/small_room.h"

namespace cgsr::localization {
namespace {

using geometry::Pose;
using testing::in_small_room;
using testing::Picture;
using testing::small_room;

constexpr double kDegree = std::numbers::pi / 180.0;

class ARival : public ::testing::Test {
 protected:
  ARival() : map_(small_room()), camera_(geometry::Camera{}.scaled_to(320, 240)), X_RC_(in_small_room(0.0, 0.0, 0.0)) {
    pictures_.reserve(kPictures);
    for (std::uint32_t i = 0; i < kPictures; ++i) pictures_.emplace_back(map_, X_WR_ * X_RC_, camera_, 1.5, i + 1);
  }

  /// Follows a robot that stands, from a belief that is surer than it is right. \return how far off the camera's position is after each image, in metres.
  std::vector<double> followed(double left_m, double turned_deg, bool rivals, int images) const {
    LocalizerParameters parameters;
    parameters.search = rivals;
    Localizer localizer(map_, camera_, parameters);
    PoseTrackerParameters on_floor;
    on_floor.floor = true;
    PoseTracker tracker(localizer, X_RC_, on_floor);
    const Pose X_WC = X_WR_ * X_RC_;
    const Pose believed = X_WR_ * geometry::pose_on_floor(0.0, left_m, turned_deg * kDegree) * X_RC_;
    tracker.start(prior_at(believed, {.x_m = 0.01, .y_m = 0.01, .z_m = 0.01, .heading_rad = 0.003, .tilt_rad = 0.003}));
    UnlimitedBudget budget;
    std::vector<double> off_m;
    off_m.reserve(static_cast<std::size_t>(images));
    for (int i = 0; i < images; ++i) {
      tracker.moved(Pose::Identity());
      const Picture& picture = pictures_[static_cast<std::size_t>(i) % kPictures];
      off_m.push_back(geometry::step_between(X_WC, tracker.see(picture.view(), budget).X_WC).head<3>().norm());
    }
    return off_m;
  }

  static constexpr std::uint32_t kPictures = 12;  // that differ in their noise
  world::Map map_;
  geometry::Camera camera_;
  Pose X_RC_;
  Pose X_WR_ = geometry::pose_on_floor(1.0, 1.6, 0.2);
  std::vector<Picture> pictures_;
};

TEST_F(ARival, BringsBackWhatHadSettledOnTheWrongEdges) {
  struct Start {
    double left_m;
    double turned_deg;
  };
  for (const auto& [left_m, turned_deg] :
       {Start{-0.12, -3.0}, Start{-0.08, -1.5}, Start{-0.05, -3.0}, Start{0.05, -3.0}}) {
    EXPECT_GT(followed(left_m, turned_deg, false, 60).back(), 0.1) << left_m << " m, " << turned_deg << " degrees";
    EXPECT_LT(followed(left_m, turned_deg, true, 60).back(), 0.01) << left_m << " m, " << turned_deg << " degrees";
  }
}

TEST_F(ARival, LeavesARightPoseWhereItIs) {
  const std::vector<double> off_m = followed(0.0, 0.0, true, 120);
  EXPECT_LT(*std::max_element(off_m.begin(), off_m.end()), 0.01);
}

}  // namespace
}  // namespace cgsr::localization
