#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp_filter.h"
#include "pipeline/shade/shadow_volumes.h"
#include "pipeline/stages/events.h"
#include "pipeline/stages/probes_stage.h"
#include "pipeline/world/map.h"
#include "platform/description.h"
#include "platform/parameters.h"
#include "platform/pool.h"

namespace cgsr::stages {

/// A lamp whose place is known beforehand: for a robot that carries no probes. Without switching nobody sees whether it burns.
struct GivenLamp {
  bool given = false;
  std::array<double, 3> position_m{};
  double sigma_m = 0.05;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("given", self.given, "A robot without a probe board computes shadows of the lamp below.");
    visit.numbers("position_m", self.position_m, {-10000.0, 10000.0}, "m", "The lamp's place in the world.");
    visit.number("sigma_m", self.sigma_m, {0.001, 10.0}, "m", "The standard deviation of each coordinate.");
  }
};

/// Section [shade] of a robot's file.
struct ShadeStageParameters {
  double max_lamp_sigma_m = 0.3;
  double max_lamp_shift_m = 0.01;
  GivenLamp lamp{};
  shade::ShadeParameters masks;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_lamp_sigma_m", self.max_lamp_sigma_m, {0.001, 10.0}, "m",
                 "Masks are computed only for a lamp whose standard deviation is at most this.");
    visit.number(
        "max_lamp_shift_m", self.max_lamp_shift_m, {0.0, 1.0}, "m",
        "The silhouettes are computed again when the lamp's estimate has moved further than this; meanwhile the old "
        "ones serve, widened by the way, unless that is longer than max_lamp_sigma_m.");
    visit.section("lamp", self.lamp, "A lamp whose place is known without probes");
    visit.section("masks", self.masks, "Computation of the shadow masks (5.2)");
  }
};

/// Whether there are shadow masks of an image; else why not.
enum class ShadeStatus : std::uint8_t {
  kMasked,       ///< there are masks.
  kNoMap,        ///< what could throw shadows is not known.
  kNoLamp,       ///< no lamp is known: ambient light only.
  kLampUnsure,   ///< known too roughly.
  kPreparing,    ///< a new place of the lamp is being prepared, and what there is lies too far off.
  kPoseUnknown,  ///< the camera's pose is not known.
  kNoRoom,       ///< every mask buffer is still read by somebody.
};
std::string_view to_string(ShadeStatus status);

/// What lies in shadow in an image.
struct ShadowMasks {
  ShadeStatus status = ShadeStatus::kNoMap;
  Lease<shade::ShadeMasks> masks;  ///< of this image; empty: none, and `status` says why.
  Events events{};                 ///< changes of the status.
  std::shared_ptr<const shade::ShadowVolumes>
      volumes{};  ///< that the masks are of, to be asked of single places; by the vision thread alone.

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.text("shade", to_string(self.status), "whether there are shadow masks, or why not");
  }
};

/// Chapter 5's second half: map, pose and lamp to the two masks of shaded regions (5.2).
///
/// Threads: one. After construction nothing here allocates.
class ShadeStage {
 public:
  using Output = ShadowMasks;
  static constexpr std::string_view kName = "shade";
  static constexpr std::string_view kMeaning =
      "What lies in the lamp's shadow: the masks, from map, pose and lamp (5.2).";
  static constexpr runtime::StageParameters kRow{2, 1, 7000, 30, runtime::OnOverrun::kSkip};
  static constexpr Duration kMaxLampAge = seconds(0.5);  ///< of the probes' report that is used.

  /// \param map  not null.  \param camera  of the images that come.
  ShadeStage(std::shared_ptr<const world::Map> map, const geometry::Camera& camera,
             const ShadeStageParameters& parameters);

  /// \param budget  asked before each unit of work on a new place of the lamp (Silhouettes::work_unit).
  /// \param pose  of this image: masks of an older one would lie beside the shadows.
  /// \param lamp  of the probes; a robot without them has the lamp of its configuration, or none.
  /// \return nothing: this turn went into a new place of the lamp, the last masks stay for now.
  std::optional<Output> update(WorkBudget& budget, const runtime::Aged<PoseEstimate>& pose,
                               const runtime::Aged<LampReport>& lamp);

  /// The same with pose and lamp as their owner knows them. \param lamp  null: none is known.
  std::optional<Output> update(WorkBudget& budget, const geometry::Pose& X_WC, const geometry::Matrix6d& covariance,
                               const illumination::KnownLamp* lamp);

 private:
  std::optional<Output> masks_for(WorkBudget& budget, const geometry::Pose& X_WC, const geometry::Matrix6d& covariance,
                                  const illumination::KnownLamp* lamp);
  Output with_events(Output output);
  [[nodiscard]] Eigen::Vector3d place_to_prepare(const Eigen::Vector3d& p_WL) const;

  std::shared_ptr<const world::Map> map_;
  geometry::Camera camera_;
  ShadeStageParameters parameters_;
  illumination::KnownLamp given_;
  std::shared_ptr<shade::ShadowVolumes> volumes_;
  Pool<shade::ShadeMasks> masks_;
  bool looked_last_ = false;  ///< the last turn gave masks: while a new place is prepared, the next does not.
  ShadeStatus status_ = ShadeStatus::kNoMap;  // of the last output
};

}  // namespace cgsr::stages
