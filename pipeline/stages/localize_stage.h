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
#include "pipeline/localization/localizer.h"
#include "pipeline/localization/pose_tracker.h"
#include "pipeline/runtime/aged.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/events.h"
#include "pipeline/world/map.h"
#include "platform/description.h"

namespace cgsr::stages {

/// Where the robot is, as its odometry and its camera say together.
struct PoseEstimate {
  bool has_map = false;              ///< else nothing below means anything.
  localization::TrackedPose camera;  ///< X_WC, its covariance, and what this image did to it.
  behavior::PlanarPose robot;        ///< X_WR on its floor.
  Events events{};                   ///< changes of the state.

  [[nodiscard]] bool known() const { return has_map && robot.known; }

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    const bool map = self.has_map;
    visit.text("pose", when(map, to_string(self.camera.state)), "state of the pose estimate");
    visit.flag("corrected", when(map, self.camera.correction.corrected), "this image corrected the pose");
    visit.text("reason", when(map, to_string(self.camera.correction.reason)), "why it did not");
    visit.number("x_m", when(map, self.robot.x_m), {4}, "m", "the robot's place in the world");
    visit.number("y_m", when(map, self.robot.y_m), {4}, "m", "likewise");
    visit.number("heading_rad", when(map, self.robot.heading_rad), {5}, "rad",
                 "its heading, from the world's x axis to the left");
    visit.number("sigma_m", when(map, std::sqrt(self.camera.covariance.template topLeftCorner<2, 2>().trace())), {4},
                 "m", "standard deviation of the camera's place along the floor");
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
  std::vector<std::uint8_t>
      self_mask;  ///< of the localizer's working size, not 0 where the robot sees itself; empty: nowhere.
};

/// Chapter 4, the localization correction of Fig. 5.1: odometry carries the pose from exposure to exposure, images correct it.
///
/// Threads: one. After construction nothing here allocates.
class LocalizeStage {
 public:
  using Output = PoseEstimate;
  static constexpr std::string_view kName = "localize";
  static constexpr std::string_view kMeaning = "The robot's pose, corrected against the map (chapter 4).";
  static constexpr runtime::StageParameters kRow{1, 0, 9000, 8, runtime::OnOverrun::kSkip};

  explicit LocalizeStage(LocalizationSetup setup);
  LocalizeStage(const LocalizeStage&) = delete;
  LocalizeStage& operator=(const LocalizeStage&) = delete;

  /// \param view  of this image: what an older one shows is not used.
  /// \param odometry  at this image's exposure; nothing: it is not known, and the pose is not carried on.
  Output update(WorkBudget& budget, const ImageView& image, const runtime::Aged<View>& view,
                const std::optional<hal::Odometry>& odometry);

  /// The same for an owner without odometry of hal's: with the image itself, at the pose that carry() and lean() led to. While a search is under
  /// way the same image may be handed over again.
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
  std::optional<geometry::Pose> X_OR_;                                  // at the last image
  localization::TrackState state_ = localization::TrackState::kUnsure;  // likewise
};

}  // namespace cgsr::stages
