#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/pose.h"
#include "pipeline/global_localization/panorama.h"
#include "pipeline/global_localization/parameters.h"
#include "pipeline/global_localization/place_index.h"
#include "pipeline/localization/correction.h"
#include "pipeline/world/map.h"
#include "platform/work_budget.h"

namespace cgsr::global_localization {

/// What the localizer made of an image of the turn.
struct CorrectedView {
  int matches = 0;           ///< by which it corrected the pose; 0: it did not.
  localization::Prior pose;  ///< of the camera, as corrected.
};

/// A place that may be the robot's.
struct Candidate {
  geometry::Pose X_WR =
      geometry::Pose::Identity();  ///< where the robot was in the first image; tried: by the localizer.
  float likeness = 0.0F;           ///< of the panoramas, at most 1: the greatest of those about it,
  geometry::Pose X_WR_alike = geometry::Pose::Identity();  ///< ... and where on the grid that is.
  bool tried = false;
  int looked_at = 0;                          ///< images of the turn that the localizer was shown.
  int corrected = 0;                          ///< of these, the ones that corrected it.
  std::array<CorrectedView, kViews> views{};  ///< what came of each image.
  std::size_t last_corrected = 0;             ///< with corrected > 0, the image that corrected it last.
};

/// \return whether two poses on the floor are that near to each other.
bool are_near(const geometry::Pose& a, const geometry::Pose& b, double distance_m, double turn_rad);

/// \return a grid of places over the map, those where the robot may stand.
std::vector<Eigen::Vector2d> grid_of_places(const world::Map& map, double spacing_m,
                                            const std::function<bool(double x_m, double y_m)>& may_stand);

/// The places of an index that are most like what was seen, each in the heading that it is seen from.
class CandidateSearch {
 public:
  /// \param index  outlives it; the neighbours of candidates are built in it.
  CandidateSearch(PlaceIndex& index, const GlobalLocalizerParameters& parameters);

  void restart();

  /// Compares, as far as the budget goes: those of the index's places that are apart, which are built before, and whatever else it holds; then the neighbours
  /// of the most alike ones, which are built too. Sixteen places a unit. \return whether the candidates are known.
  bool go_on(const Panorama& seen, WorkBudget& budget);

  /// The most alike first.
  [[nodiscard]] std::span<const Candidate> candidates() const { return candidates_; }
  [[nodiscard]] std::span<Candidate> candidates() { return candidates_; }

 private:
  /// Places about one, as far as they were compared.
  struct About {
    About(const geometry::Pose& of, float its_likeness) : X_WR(of), likeness(its_likeness), X_WR_alike(of) {}

    geometry::Pose X_WR;
    float likeness;
    std::size_t next = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();  ///< of their offsets and turns, metres and radians, by weight.
    double weights = 0.0;
    float most_alike = 0.0F;
    geometry::Pose X_WR_alike;  ///< where that is.
    bool moved = false;         ///< to what was the most alike place about another one.
  };

  std::optional<Panorama::Likeness> compare(std::size_t place, const Panorama& seen, WorkBudget& budget);
  void propose(std::size_t place, const Panorama::Likeness& likeness);
  bool sharpen(Candidate& candidate, const Panorama& seen, WorkBudget& budget);
  bool look_about(const Panorama& seen, WorkBudget& budget);
  bool leave_out_double();

  PlaceIndex* index_;
  GlobalLocalizerParameters parameters_;
  std::size_t most_proposed_;
  std::vector<Candidate> candidates_;
  std::size_t next_place_ = 0;
  int compared_ = 0;            ///< places, of this unit.
  std::size_t sharpened_ = 0;   ///< candidates.
  std::optional<About> about_;  ///< the next one.
};

}  // namespace cgsr::global_localization
