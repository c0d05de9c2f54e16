#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "pipeline/geometry/pose.h"
#include "pipeline/global_localization/candidates.h"
#include "pipeline/global_localization/parameters.h"
#include "pipeline/global_localization/turn.h"
#include "pipeline/localization/localizer.h"
#include "pipeline/localization/pose_tracker.h"
#include "platform/image_view.h"
#include "platform/work_budget.h"

namespace cgsr::global_localization {

/// Confirms a candidate's pose by the image of now. The robot turns until it faces a view of the turn in which the localizer found much of the map during
/// the trial, and stands while that is looked at again, from the pose that was found then: one that turns sees another view before a search has ended. Mostly
/// it faces one already, the last of the turn. A robot that stands although it should turn is looked from as it stands.
///
/// An image may be matched with edges that lie beside the right ones, and be sure of it. It confirms the pose only where most of the trial's other views agree
/// with it, or another one that was looked at again.
///
/// Allocates nothing.
class Settling {
 public:
  /// \param localizer  outlives it.
  Settling(localization::Localizer& localizer, const geometry::Pose& X_RC,
           const localization::PoseTrackerParameters& tracking, const GlobalLocalizerParameters& parameters);

  /// \param candidate  that was tried in images of the turn.
  void begin(const Candidate& candidate, const Turn& turn);

  /// \param turn  whole, with the images in which the candidate was tried; it has followed the motion to this image.
  /// \return whether the pose is confirmed, or no view is left that could do so; nothing: it goes on.
  std::optional<bool> update(const Turn& turn, const ImageView& image, const Motion& motion, WorkBudget& budget,
                             const std::uint8_t* mask);

  [[nodiscard]] bool wants_turn() const { return wants_turn_; }
  /// With wants_turn(): the nearest view lies the other way round than the turn went.
  [[nodiscard]] bool turns_back() const { return turns_back_; }
  /// The camera at the last image.
  [[nodiscard]] const localization::TrackedPose& now() const { return tracker_.now(); }

 private:
  /// Where a view has the robot.
  struct Opinion {
    geometry::Pose X_WF;  ///< the frame of the turn's first image (Turn::X_FR).
    double turned_rad;    ///< where it was seen from (Turn::turned_rad).
  };

  [[nodiscard]] std::optional<std::size_t> nearest_view(const Turn& turn, double within_rad) const;
  [[nodiscard]] std::optional<std::size_t> faced_view(const Turn& turn);
  void turn_on(const Turn& turn);
  void face(std::size_t view, const Turn& turn);
  [[nodiscard]] bool stands(const Turn& turn) const;
  [[nodiscard]] bool begins_to_look(const Turn& turn);
  [[nodiscard]] std::optional<bool> judge(const Turn& turn);
  [[nodiscard]] bool is_sure() const;
  [[nodiscard]] bool agrees(const Turn& turn) const;

  geometry::Pose X_RC_;
  localization::Localizer* localizer_;
  localization::PoseTracker tracker_;
  GlobalLocalizerParameters parameters_;
  std::array<CorrectedView, kViews> views_{};  ///< of the turn; without matches where they are not worth a look.
  std::optional<std::size_t> view_;            ///< that the robot faces; nothing: it turns.
  std::array<std::optional<Opinion>, kViews> tried_{};      ///< by the trial,
  std::array<std::optional<Opinion>, kViews> looked_at_{};  ///< ... and looked at again, and sure.
  bool wants_turn_ = false;
  bool turns_back_ = false;
  bool looking_ = false;
  int braking_images_ = 0;
  int unsure_images_ = 0;  ///< of this look, that corrected the pose and left it too uncertain.
  int images_ = 0;
  std::optional<double> begun_rad_;  ///< turned when it began.
  double turned_before_rad_ = 0.0;
  int standing_images_ = 0;                                  ///< without a view that is worth a look.
  geometry::Pose X_FR_before_ = geometry::Pose::Identity();  ///< since the turn's first image, at the image before.
};

}  // namespace cgsr::global_localization
