#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/probe_observation.h"
#include "platform/error.h"
#include "platform/parameters.h"

namespace cgsr::illumination {

/// Section [lamp] of a robot's file: what is known of lamps beforehand, and how observations of one are pulled together.
struct LampParameters {
  double height_m = 2.75;
  double height_sigma_m = 0.02;
  double max_disagreement_m = 0.5;
  double min_pose_sigma_m = 0.01;
  double min_pose_sigma_deg = 0.3;
  double pose_error_way_m = 1.5;
  double pose_error_turn_deg = 115.0;
  int min_steady_images = 3;
  int max_missing_images = 6;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("height_m", self.height_m, {0.1, 20.0}, "m",
                 "The height of a lamp above the floor, where it is not measured.");
    visit.number("height_sigma_m", self.height_sigma_m, {1e-4, 10.0}, "m",
                 "The standard deviation of that height; a large value lets two shadows or several viewpoints "
                 "determine the height.");
    visit.number("max_disagreement_m", self.max_disagreement_m, {0.01, 10.0}, "m",
                 "Observations are rejected when two probes place the lamp further apart than this.");
    visit.number("min_pose_sigma_m", self.min_pose_sigma_m, {0.0, 1.0}, "m",
                 "The smallest standard deviation of the robot's position that is used, whatever its estimate states.");
    visit.number("min_pose_sigma_deg", self.min_pose_sigma_deg, {0.0, 20.0}, "deg",
                 "The smallest standard deviation of the robot's heading that is used, whatever its estimate states.");
    visit.number("pose_error_way_m", self.pose_error_way_m, {0.0, 1000.0}, "m",
                 "The way over which the error of the robot's pose fades to 1/e; 0: it is another one in every image.");
    visit.number(
        "pose_error_turn_deg", self.pose_error_turn_deg, {0.0, 36000.0}, "deg",
        "The turn over which the error of the robot's pose fades to 1/e; 0: it is another one in every image.");
    visit.number("min_steady_images", self.min_steady_images, {1, 1000}, "",
                 "The number of images that must agree before a lamp is accepted.");
    visit.number("max_missing_images", self.max_missing_images, {1, 1000}, "",
                 "A lamp is off or has moved after this many consecutive images without the expected shadow.");
  }
};

/// What became of one lamp in one image.
enum class LampStatus : std::uint8_t {
  kFound,      ///< a place with its covariance.
  kPartial,    ///< one line of one probe: the lamp lies in a plane.
  kNoShadow,   ///< nothing to go by.
  kDisagree,   ///< the probes' rays meet the lamp's height too far apart: the image is discarded.
  kBelowTips,  ///< the lamp's height is not above the probes' tips.
};
std::string_view to_string(LampStatus status);

/// Where a lamp is, robot frame.
struct LampEstimate {
  LampStatus status = LampStatus::kNoShadow;
  Eigen::Vector3d p_RL = Eigen::Vector3d::Zero();
  /// Of pixel noise, registration and the stated errors of board and probes; of one line, large along the plane.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  int probes = 0;          ///< bit i: probe i saw its shadow.
  int lines = 0;           ///< of all shadows together.
  double angle_rad = 0.0;  ///< of the light from the vertical, at the probes.

  /// Both shadows: the lamp where their rays come nearest, no height assumed.
  bool triangulated = false;
  Eigen::Vector3d p_RL_triangulated = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_triangulated = Eigen::Matrix3d::Zero();
  /// The rays tell the height better than it was known. p_RL stays the fit that leans on the known height.
  bool height_measured = false;
};

/// \return what cannot be: a lamp that hangs no higher than the probes' tips.
Result<void> check_lamp(const Board& board, const LampParameters& parameters);

/// The ray of a tip's shadow through its tip, cut at a height (Eq. 5.1, 5.2). All in the board's frame. `z_m` is above the tip.
Eigen::Vector3d on_ray(const Eigen::Vector2d& p_BS, const Eigen::Vector3d& p_BA, double z_m);

/// A tip above a plane z = 0 and where its shadow falls on it, in the plane's frame.
struct TipShadow {
  Eigen::Vector3d p_A = Eigen::Vector3d::Zero();
  Eigen::Vector2d p_S = Eigen::Vector2d::Zero();
};
/// The point that is nearest to all rays from shadows through their tips: a lamp with its height, plain least squares.
/// \return nothing: fewer than two rays, or rays that are parallel.
std::optional<Eigen::Vector3d> nearest_to_rays(std::span<const TipShadow> shadows);

/// A tip's shadow as it follows from a lamp, with its derivatives.
struct ShadowModel {
  Eigen::Vector2d p_BS;
  Eigen::Matrix<double, 2, 3> J_lamp;
  Eigen::Matrix<double, 2, 3> J_tip;
};
ShadowModel shadow_of(const Eigen::Vector3d& p_BL, const Eigen::Vector3d& p_BA);

/// One lamp out of one shadow per probe at the most (nullptr: not seen). Weighted by covariances: with two rays that agree it is their mean, with
/// one that ray at the known height, and lines alone combine as planes.
LampEstimate estimate_lamp(const Board& board, const LampParameters& parameters,
                           const std::array<const ProbeShadow*, kMostProbes>& shadow,
                           const geometry::Matrix6d& registration_covariance);

/// All lamps of one image: shadows of the two probes are paired so that their rays meet.
struct LampEstimates {
  std::array<LampEstimate, ShadowFinder::kMostShadows> lamp;
  int count = 0;
  LampStatus status = LampStatus::kNoShadow;  ///< of the first lamp; why there is none.
};
LampEstimates locate_lamps(const Board& board, const LampParameters& parameters, const ProbeObservation& observation);

}  // namespace cgsr::illumination
