#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "pipeline/geometry/camera.h"
#include "pipeline/localization/correction.h"
#include "pipeline/localization/localizer_parameters.h"
#include "pipeline/localization/segment_table.h"
#include "pipeline/localization/solve.h"
#include "pipeline/render/expectation.h"
#include "pipeline/world/map.h"
#include "platform/image_view.h"
#include "platform/work_budget.h"

namespace cgsr::localization {

/// Corrects a camera's pose against a map: glCorrect (4.2) and Stronger's method (Alg. 4.1) with shared perception, matching and solver.
///
/// Where the prior is narrow one image is one answer: expectation and maximisation alternate from the prior. Where it is wide a search runs
/// that may take several images: correct() answers kSearching until it has an answer; hypotheses are kept meanwhile, and carried() moves them
/// as the robot moves. With a still camera the same image may be handed over again.
///
/// correct() allocates nothing after construction. Threads: one caller at a time.
class Localizer {
 public:
  /// \param map, outlives it.  \param camera  with its lens, in the size of the largest images; half the size is taken too.
  /// \param expectation  what draws the visible edges; none: DepthRaster, or every edge for Method::kStronger.
  Localizer(const world::Map& map, const geometry::Camera& camera, const LocalizerParameters& parameters,
            std::unique_ptr<render::Expectation> expectation = nullptr);
  ~Localizer();
  Localizer(Localizer&&) noexcept;
  Localizer& operator=(Localizer&&) noexcept;

  /// \param image  kYuyv or kGrey8, of the camera's size (halved here when its shorter side is at least 400 px) or half of it in both
  ///        directions (ReducedImage::grey).
  /// \param prior  where the camera is believed to be now.  \param budget  asked before each look or round of matching.
  /// \param mask  nonzero: a pixel of the robot's own; of the working size, tight, or null.
  Correction correct(const ImageView& image, const Prior& prior, WorkBudget& budget,
                     const std::uint8_t* mask = nullptr);

  /// The camera moved between images by X_C0C1: hypotheses under way go along.
  void carried(const geometry::Pose& X_C0C1);

  /// \return a covariance in the map as it is (Correction's) with the map's own error: that in the world.
  [[nodiscard]] geometry::Matrix6d in_world(const geometry::Matrix6d& covariance) const;

  /// Forgets a search under way: the next prior is a new one.
  void restart();

  [[nodiscard]] bool searching() const;

  /// Camera of perceived edges: without lens, in the working size.
  [[nodiscard]] const geometry::Camera& camera() const;

  /// Of one image, for who solves for the poses of several together: the map looked at from a pose, matched with what was perceived no farther off than
  /// radius_px. Takes a look and a round (work.h), which the caller asks a budget for; not while a search is under way. \return valid until the next call.
  std::span<const LineDistance> distances_from(const geometry::Pose& X_WC, const SegmentTable& perceived,
                                               float radius_px);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::localization
