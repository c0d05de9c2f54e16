#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pipeline/illumination/lamp.h"
#include "pipeline/illumination/luma_view.h"
#include "pipeline/illumination/probe_observation.h"
#include "pipeline/illumination/registration.h"
#include "pipeline/illumination/shadow_lines.h"

namespace cgsr::illumination {

/// What a pair of images says about board and probes.
enum class SwitchVerdict : std::uint8_t {
  kAgrees,         ///< every shadow that the lamp throws falls where board and probes say.
  kDisagrees,      ///< one does not: a probe stands elsewhere than its calibration says, or the lamp does.
  kNoShadow,       ///< the lamp makes a difference, and no probe's shadow is in it.
  kNoDifference,   ///< the images are the same: the lamp did not switch.
  kMoved,          ///< the camera moved between both images.
  kNoImage,        ///< one is missing, of another size, or without brightness.
  kNotRegistered,  ///< board and cones are not to be found in the image with the lamp.
  kNoAnswer,       ///< the lamp's line does not answer: there are no two images.
};
std::string_view to_string(SwitchVerdict verdict);

/// A verdict with what it rests on.
struct SwitchCheck {
  SwitchVerdict verdict = SwitchVerdict::kNoImage;
  std::array<bool, kMostProbes> seen{};
  std::array<Eigen::Vector2d, kMostProbes> off_m{};  ///< of the shadow from where it should fall, board's frame.
  std::array<double, kMostProbes> chi2{};            ///< of that, 2 degrees of freedom.
  double difference = 0.0;                           ///< grey levels, mean over the board.
};

/// An active check of the probes: what a lamp alone does is the difference of an image with it and one without, in which no other light's
/// shadow, no texture and no dirt is left. Where the lamp is known, its shadows say whether board and probes still are as calibrated.
/// Ours; where the shadows should fall follows from the rays of Eq. 5.1 and 5.2.
///
/// Allocates when constructed, not when it checks. Threads: one.
class SwitchChecker {
 public:
  SwitchChecker(const Board& board, const ProbesParameters& parameters, double lamp_height_m);

  /// \param on, off  with the lamp and without it, from the same place. \param p_RL  where the lamp is, robot frame.
  /// \param lamp_sigma_m  how well that is known, each coordinate.
  SwitchCheck check(const ImageView& on, const ImageView& off, const Eigen::Vector3d& p_RL, double lamp_sigma_m);

 private:
  struct Lamp {
    Eigen::Vector3d p_BL;
    double sigma_m;
  };

  [[nodiscard]] bool can_compare(const ImageView& on, const ImageView& off) const;
  [[nodiscard]] bool has_moved(const Registration& registration, const ImageView& off) const;
  LumaView subtract(const ImageView& on, const ImageView& off, const geometry::Pose& X_BC);
  [[nodiscard]] double mean_on_board(const LumaView& image, const geometry::Pose& X_BC) const;
  void compare_shadow(std::size_t probe, const ShadowFinder::Found& found, const Lamp& lamp,
                      const geometry::Matrix6d& registration, SwitchCheck& check) const;

  Board board_;
  ProbesParameters parameters_;
  std::vector<ShadowFinder> finders_;
  std::vector<std::uint8_t> difference_;
};

}  // namespace cgsr::illumination
