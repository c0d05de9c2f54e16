#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/global_localization/candidates.h"
#include "pipeline/global_localization/panorama.h"
#include "pipeline/global_localization/parameters.h"
#include "pipeline/global_localization/phase.h"
#include "pipeline/global_localization/place_index.h"
#include "pipeline/global_localization/settling.h"
#include "pipeline/global_localization/turn.h"
#include "pipeline/global_localization/turn_fit.h"
#include "pipeline/localization/localizer.h"
#include "pipeline/localization/pose_tracker.h"
#include "pipeline/world/map.h"
#include "platform/image_view.h"
#include "platform/work_budget.h"

namespace cgsr::global_localization {

/// The pose of a robot that was put down anywhere in its map, without a marker or a last run. While it turns on the spot once, twelve images make a
/// panorama of edges; that is compared with the map's own panoramas from a grid of places, in every heading; the most alike ones are fitted
/// to all images of the turn together and handed to the localizer of chapter 4, which looks at these images one by one. A place is the robot's when the localizer corrects it in several of
/// these images, and no other place that was tried in more than half as large a share of them; an image of now confirms it.
/// Ours: the dissertation starts from a known pose (4.1).
///
/// What perceives an image's edges comes before all units of work, as for the localizer; so do closing and gathering the turn, which have an image each and
/// cost less than that. Fewer units than kMinSearchUnits come to no end. Threads: one caller at a time. Allocates nothing after
/// construction.
class GlobalLocalizer {
 public:
  /// \param map, localizer  outlive it; nobody else uses the localizer until there is an answer.  \param camera  with its lens, as the localizer's.
  /// \param places_m  where the robot may be (grid_of_places), at least one.
  GlobalLocalizer(const world::Map& map, const geometry::Camera& camera, const geometry::Pose& X_RC,
                  std::vector<Eigen::Vector2d> places_m, localization::Localizer& localizer,
                  const localization::PoseTrackerParameters& tracking, const GlobalLocalizerParameters& parameters);

  /// \param image  as Localizer::correct takes it.  \param mask  likewise.
  Phase update(const ImageView& image, const Motion& motion, WorkBudget& budget, const std::uint8_t* mask = nullptr);

  /// Whether update() will look at the image that comes with this motion, not at its motion alone.
  [[nodiscard]] bool looks_at(const Motion& motion) const;

  /// Begins to turn again; what was worked out of the map stays.
  void restart();

  [[nodiscard]] Phase phase() const { return phase_; }
  /// While true the robot should turn on the spot, at most 45 degrees a second; either way round. Once it has turned once and up to a sixth more it should
  /// stand; then it turns to a view that confirms the pose, and stands again.
  [[nodiscard]] bool wants_turn() const {
    return phase_ == Phase::kTurning || (phase_ == Phase::kSettling && settling_.wants_turn());
  }
  /// With wants_turn(): back would be the shorter way to that view. A robot that turns on finds it too.
  [[nodiscard]] bool turns_back() const { return phase_ == Phase::kSettling && settling_.turns_back(); }
  /// The camera's pose at the last image; with kFound.
  [[nodiscard]] const localization::TrackedPose& found() const { return settling_.now(); }
  /// The most alike first; from kTrying on.
  [[nodiscard]] std::span<const Candidate> candidates() const { return search_.candidates(); }

 private:
  bool try_candidates(WorkBudget& budget, const std::uint8_t* mask);
  [[nodiscard]] bool worth_trying(const Candidate& candidate) const;
  [[nodiscard]] bool is_nearly_as_alike(const Candidate& candidate) const;
  [[nodiscard]] bool is_corrected(const Candidate& candidate) const;
  [[nodiscard]] bool any_is_corrected() const;
  [[nodiscard]] int most_failed() const;
  void choose_order();
  bool fit(const Candidate& candidate, WorkBudget& budget);
  [[nodiscard]] localization::Prior prior_of_look(const Candidate& candidate) const;
  [[nodiscard]] bool goes_on(const Candidate& candidate) const;
  void look_at_next(Candidate& candidate, WorkBudget& budget, const std::uint8_t* mask);
  void end_trial(Candidate& candidate);
  [[nodiscard]] Phase verdict();
  geometry::Pose X_RC_;
  GlobalLocalizerParameters parameters_;
  localization::Localizer* localizer_;
  localization::PoseTracker tracker_;  ///< of a candidate, at an image of the turn.
  Settling settling_;                  ///< of the best one, over the images that come after it.
  Turn turn_;
  PlaceIndex index_;
  CandidateSearch search_;
  TurnFit fit_;  ///< of the candidate under trial.
  Panorama seen_;
  std::size_t trial_ = 0;                        ///< candidate under trial.
  std::array<std::size_t, kKeyframes> order_{};  ///< of the images of the turn in every trial.
  int looks_ = 0;                                ///< at most; so many of order_ are used.
  int looks_to_last_ = 0;                        ///< until the last image of the turn is among them.
  Phase phase_ = Phase::kTurning;
  bool closed_ = false;    ///< the turn is.
  bool gathered_ = false;  ///< seen_ is.
  bool under_trial_ = false;
  bool fitted_ = false;       ///< that candidate is.
  bool follows_fit_ = false;  ///< an image corrected it from where the fit has it.
  bool looking_ = false;      ///< at an image of the turn, since an earlier update.
};

}  // namespace cgsr::global_localization
