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
#include "pipeline/stages/time_lost.h"
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
  /// How far the search of the whole map for the pose has come; kFound while none is under way, be the pose lost or not.
  global_localization::Phase search = global_localization::Phase::kFound;
  bool anew = false;        ///< with a search: for a pose that was lost for long; otherwise for the first one.
  double turn_radps = 0.0;  ///< that this search asks for, on the spot, positive to the left.
  Events events{};          ///< changes of the state.

  [[nodiscard]] bool known() const { return has_map && robot.known; }
  /// The whole map is searched for the pose: the robot should do as `turn_radps` says and nothing else.
  [[nodiscard]] bool seeks_pose() const { return search != global_localization::Phase::kFound; }
  /// \return what is sought, as events and people call it.
  [[nodiscard]] std::string_view sought() const { return anew ? "new pose" : "first pose"; }

  /// \return the word of the search of the whole map, and without one of the pose that is carried on.
  [[nodiscard]] std::string_view state() const { return seeks_pose() ? to_string(search) : to_string(camera.state); }

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    const bool map = self.has_map;
    const bool somewhere = map && !self.seeks_pose();
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
  /// Where the robot may be (grid_of_places), for one that searches the whole map for its pose; empty: it begins at `start` and never does.
  std::vector<Eigen::Vector2d> places_m;
  /// It does so at first, for nobody tells it where it is; otherwise it begins at `start`.
  bool seeks_first_pose = false;
  double seek_turn_radps = 0.6;               ///< on the spot, while it does so; at most 45 degrees a second.
  Duration seek_again_after = seconds(10.0);  ///< TimeLost, after which it does so again; zero: never.
  std::vector<std::uint8_t>
      self_mask;  ///< of the localizer's working size, not 0 where the robot sees itself; empty: nowhere.
};

/// Chapter 4, the localization correction of Fig. 5.1: odometry carries the pose from exposure to exposure, images correct it. A robot that may be
/// anywhere in its map first seeks its pose while it turns on the spot, and again when it is lost for long. After kMaxTurns turns without an answer it gives
/// up: without a pose it stands; with a lost one it goes on from there, as lost as before, and seeks no more until an image has corrected its pose.
///
/// Threads: one. After construction nothing here allocates.
class LocalizeStage {
 public:
  using Output = PoseEstimate;
  static constexpr std::string_view kName = "localize";
  static constexpr std::string_view kMeaning = "The robot's pose, corrected against the map (chapter 4).";
  static constexpr runtime::StageParameters kRow{1, 0, 9000, 8, runtime::OnOverrun::kSkip};

  static constexpr int kMaxTurns = 3;

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
  /// Of the search for the pose, as PoseEstimate has it.
  void tell_search(PoseEstimate& pose) const;
  PoseEstimate seek_pose(WorkBudget& budget, const ImageView& image);
  void turn_led_nowhere(PoseEstimate& pose);
  void seek_anew(PoseEstimate& pose);
  void go_on_lost(PoseEstimate& pose);
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
  std::unique_ptr<global_localization::GlobalLocalizer> whole_map_;  // null: it is never searched
  double seek_turn_radps_;
  Duration seek_again_after_;
  bool seeks_ = false;  // it is searched now
  bool anew_ = false;
  int turns_ = 0;  // of this search, that led to no pose
  TimeLost time_lost_;
  geometry::Pose X_OR_lost_ = geometry::Pose::Identity();               // where it began to seek anew
  std::optional<geometry::Pose> X_OR_;                                  // at the last image
  double pitch_rad_ = 0.0;                                              // likewise
  localization::TrackState state_ = localization::TrackState::kUnsure;  // likewise
};

}  // namespace cgsr::stages
