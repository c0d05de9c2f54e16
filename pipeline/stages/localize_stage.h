#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "hal/drive.h"
#include "pipeline/behavior/route.h"
#include "pipeline/geometry/camera.h"
#include "pipeline/global_localization/phase.h"
#include "pipeline/localization/localizer.h"
#include "pipeline/localization/pose_tracker.h"
#include "pipeline/runtime/aged.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/events.h"
#include "pipeline/world/map.h"
#include "platform/description.h"

namespace cgsr::global_localization {
class GlobalLocalizer;
}

namespace cgsr::stages {

/// Where the robot is, as its odometry and its camera say together.
struct PoseEstimate {
  bool has_map = false;              ///< else nothing below means anything.
  localization::TrackedPose camera;  ///< X_WC, its covariance, and what this image did to it.
  behavior::PlanarPose robot;        ///< X_WR on its floor.
  /// How far the search for the first pose has come; where the robot was told it, kFound from the beginning.
  global_localization::Phase first_pose = global_localization::Phase::kFound;
  double turn_radps = 0.0;  ///< that this search asks for, on the spot, positive to the left.
  Events events{};          ///< changes of the state.

  [[nodiscard]] bool known() const { return has_map && robot.known; }
  /// Nobody told the robot where it is, and it does not know yet: it should do as `turn_radps` says and nothing else.
  [[nodiscard]] bool seeks_first_pose() const { return first_pose != global_localization::Phase::kFound; }

  /// \return the word of the search for the first pose, and once that is found of the pose that is carried on.
  [[nodiscard]] std::string_view state() const {
    return seeks_first_pose() ? to_string(first_pose) : to_string(camera.state);
  }

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    const bool map = self.has_map;
    const bool somewhere = map && !self.seeks_first_pose();
    visit.text("pose", when(map, self.state()), "state of the pose estimate");
    visit.flag("corrected", when(map, self.camera.correction.corrected), "this image corrected the pose");
    visit.text("reason", when(map, to_string(self.camera.correction.reason)), "why it did not");
    visit.number("x_m", when(somewhere, self.robot.x_m), {4}, "m", "the robot's place in the world");
    visit.number("y_m", when(somewhere, self.robot.y_m), {4}, "m", "likewise");
    visit.number("heading_rad", when(somewhere, self.robot.heading_rad), {5}, "rad",
                 "its heading, from the world's x axis to the left");
    visit.number("sigma_m", when(somewhere, std::sqrt(self.camera.covariance.template topLeftCorner<2, 2>().trace())),
                 {4}, "m", "standard deviation of the camera's place along the floor");
  }
};

/// What localization needs to know before the first image.
struct LocalizationSetup {
  std::shared_ptr<const world::Map> map;             ///< not null, with at least one edge.
  std::unique_ptr<render::Expectation> expectation;  ///< of that map; null: the localizer makes its own.
  geometry::Camera camera;                           ///< with its lens, in the size of the images that come.
  geometry::Pose X_RC = geometry::Pose::Identity();
  double axle_height_m = 0.24;  ///< about which the base leans.
  localization::LocalizerParameters localizer;
  localization::PoseTrackerParameters tracking;
  localization::Prior start;  ///< of the camera.
  /// Where the robot may have been put down (grid_of_places), for one that nobody tells where; empty: it begins at `start`.
  std::vector<Eigen::Vector2d> start_places_m;
  double first_turn_radps = 0.6;  ///< on the spot, while it seeks its first pose; at most 45 degrees a second.
  std::vector<std::uint8_t>
      self_mask;  ///< of the localizer's working size, not 0 where the robot sees itself; empty: nowhere.
};

/// Chapter 4, the localization correction of Fig. 5.1: odometry carries the pose from exposure to exposure, images correct it. A robot that may be
/// anywhere in its map first seeks its pose while it turns on the spot; after kFirstTurns turns without an answer it gives up and stands.
///
/// Threads: one. After construction nothing here allocates.
class LocalizeStage {
 public:
  using Output = PoseEstimate;
  static constexpr std::string_view kName = "localize";
  static constexpr std::string_view kMeaning = "The robot's pose, corrected against the map (chapter 4).";
  static constexpr runtime::StageParameters kRow{1, 0, 9000, 8, runtime::OnOverrun::kSkip};

  static constexpr int kFirstTurns = 3;

  explicit LocalizeStage(LocalizationSetup setup);
  ~LocalizeStage();
  LocalizeStage(const LocalizeStage&) = delete;
  LocalizeStage& operator=(const LocalizeStage&) = delete;

  /// \param view  of this image: what an older one shows is not used.
  /// \param odometry  at this image's exposure; nothing: it is not known, and the pose is not carried on.
  Output update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                const std::optional<hal::Odometry>& odometry);

  /// The same for an owner without odometry of hal's, who knows where the robot begins: with the image itself, at the pose that carry() and lean() led
  /// to. While a search is under way the same image may be handed over again.
  Output update(WorkBudget& budget, const ImageView& image);
  /// The robot moved by X_R0R1 since the last image.
  void carry(const geometry::Pose& X_R0R1) { tracker_.moved(X_R0R1); }
  /// The robot's pitch in the coming image, positive nose down, about an axle that high; carry() contains it.
  void lean(double pitch_rad, double axle_height_m) { tracker_.pitched(pitch_rad, axle_height_m); }

  /// Corrects this prior of the camera instead of the pose that is carried on, which stays as it is. A search goes on with the next call, until
  /// restart(). \return what became of it; kSearching: there is no answer yet.
  localization::Correction correct(WorkBudget& budget, const ImageView& image, const localization::Prior& prior);
  void restart() { localizer_.restart(); }
  [[nodiscard]] bool searching() const { return localizer_.searching(); }

 private:
  [[nodiscard]] bool takes(const ImageView& image) const;
  [[nodiscard]] bool seeks_first_pose() const;
  PoseEstimate seek_first_pose(WorkBudget& budget, const ImageView& image);
  /// What the camera's pose says of the robot, and whether that is news.
  void tell(PoseEstimate& pose);
  void carry_on(const hal::Odometry& odometry);
  [[nodiscard]] const std::uint8_t* mask() const { return self_mask_.empty() ? nullptr : self_mask_.data(); }

  std::shared_ptr<const world::Map> map_;
  geometry::Pose X_CR_;
  double axle_height_m_;
  geometry::Camera camera_;
  geometry::Camera working_;
  localization::Localizer localizer_;
  localization::PoseTracker tracker_;
  std::vector<std::uint8_t> self_mask_;
  std::unique_ptr<global_localization::GlobalLocalizer> first_pose_;  // null: the robot was told where it begins
  double first_turn_radps_;
  int first_turns_ = 0;                                                 // that led to no pose
  std::optional<geometry::Pose> X_OR_;                                  // at the last image
  double pitch_rad_ = 0.0;                                              // likewise
  localization::TrackState state_ = localization::TrackState::kUnsure;  // likewise
};

}  // namespace cgsr::stages
