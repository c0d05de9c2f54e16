#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "platform/error.h"
#include "platform/parameters.h"

namespace cgsr::illumination {

inline constexpr int kMostProbes = 2;

/// A matt cone on the board, as it was measured: robot frame, metres.
struct ProbeParameters {
  std::array<double, 3> apex_m{0.45, 0.20, 1.0};
  std::array<double, 3> foot_m{0.45, 0.20, 0.9};
  double base_radius_m = 0.02;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.numbers("apex_m", self.apex_m, {-5.0, 5.0}, "m", "The position of the cone's tip, in the robot's frame.");
    visit.numbers("foot_m", self.foot_m, {-5.0, 5.0}, "m",
                  "The position of the centre of the cone's base, in the robot's frame.");
    visit.number("base_radius_m", self.base_radius_m, {0.002, 0.5}, "m", "The radius of the cone's base.");
  }
};

/// The white board with its probes and how well all of it was measured: section [probes.board] of a robot's file.
struct BoardParameters {
  int probes = 0;
  std::array<double, 3> position_m{0.44, 0.0, 0.90};
  std::array<double, 3> turn_deg{0.0, 0.0, 0.0};
  double width_m = 0.74;
  double depth_m = 0.34;
  ProbeParameters left;
  ProbeParameters right{{0.45, -0.20, 1.0}, {0.45, -0.20, 0.9}, 0.02};
  double place_sigma_m = 0.0006;
  double turn_sigma_deg = 0.2;
  double mount_sigma_m = 0.005;
  double mount_sigma_deg = 0.4;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number(
        "probes", self.probes, {0, kMostProbes}, "",
        "The number of cones on the board; 0 means that the robot has no board, and 1 means only the left cone.");
    visit.numbers("position_m", self.position_m, {-5.0, 5.0}, "m",
                  "The centre of the board's upper face, in the robot's frame.");
    visit.numbers("turn_deg", self.turn_deg, {-45.0, 45.0}, "deg",
                  "The rotation of the board out of the horizontal, as a rotation vector in the robot's frame.");
    visit.number("width_m", self.width_m, {0.05, 5.0}, "m", "The size of the board across the robot.");
    visit.number("depth_m", self.depth_m, {0.05, 5.0}, "m", "The size of the board along the robot.");
    visit.section("left", self.left, "The left cone");
    visit.section("right", self.right, "The right cone");
    visit.number("place_sigma_m", self.place_sigma_m, {0.0, 0.1}, "m",
                 "The standard deviation of each measured coordinate of tip and base.");
    visit.number("turn_sigma_deg", self.turn_sigma_deg, {0.0, 20.0}, "deg",
                 "The standard deviation of the board's rotation about each axis.");
    visit.number("mount_sigma_m", self.mount_sigma_m, {1e-5, 0.5}, "m",
                 "The standard deviation of each coordinate of the camera's position relative to the board, before the "
                 "board has been observed.");
    visit.number("mount_sigma_deg", self.mount_sigma_deg, {1e-3, 20.0}, "deg",
                 "The standard deviation of the camera's rotation relative to the board about each axis, before the "
                 "board has been observed.");
  }
};

/// A cone in the board's frame B: origin in the middle of the upper face, z up out of it.
struct Probe {
  Eigen::Vector3d p_BA = Eigen::Vector3d::Zero();    ///< tip.
  Eigen::Vector2d foot_B = Eigen::Vector2d::Zero();  ///< middle of the base, on the board's plane.
  double radius_m = 0.0;
};

/// Board, probes and camera as calibrated: what the observation starts from. Nothing in it is a pixel.
struct Board {
  geometry::Pose X_RB = geometry::Pose::Identity();
  geometry::Pose X_BC = geometry::Pose::Identity();  ///< by the camera's mount: the prior of every registration.
  geometry::Camera camera;
  double width_m = 0.0;                  ///< along B's y.
  double depth_m = 0.0;                  ///< along B's x.
  std::array<Probe, kMostProbes> probe;  ///< left, right.
  int probes = 0;
  double place_sigma_m = 0.0;
  double turn_sigma_rad = 0.0;
  double mount_sigma_m = 0.0;
  double mount_sigma_rad = 0.0;
};

/// \param X_RC  the camera's mount.
/// \return what cannot be: no probe, a tip below its base, a foot off the board or the board, a probe that the camera does not see.
Result<Board> make_board(const BoardParameters& parameters, const geometry::Pose& X_RC, const geometry::Camera& camera);

/// A camera against the board, ready to project many points: with the derivative of the pixel.
class BoardView {
 public:
  BoardView(const geometry::Camera& camera, const geometry::Pose& X_BC);

  struct Pixel {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    bool in_front = false;
  };
  [[nodiscard]] Pixel pixel(const Eigen::Vector3d& p_B) const;

  struct Derivative {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, 3> J_point = Eigen::Matrix<double, 2, 3>::Zero();  ///< d pixel / d p_B.
    bool in_front = false;
  };
  [[nodiscard]] Derivative derivative(const Eigen::Vector3d& p_B) const;

  /// d pixel / d step, the step being that of geometry::moved(X_BC, step), out of d pixel / d p_B.
  [[nodiscard]] Eigen::Matrix<double, 2, 6> pose_jacobian(const Derivative& derivative,
                                                          const Eigen::Vector3d& p_B) const;

  [[nodiscard]] const Eigen::Vector3d& p_BC() const { return p_BC_; }

 private:
  geometry::Camera camera_;
  Eigen::Matrix3d R_CB_;
  Eigen::Vector3d p_BC_;
};

/// Where the straight line from `from` through `tip` meets the board's plane: a lamp's shadow of a tip, or what a camera sees behind it.
/// `from` is higher than `tip`.
Eigen::Vector2d cast(const Eigen::Vector3d& from, const Eigen::Vector3d& tip);

/// The two lines on the board's plane from the shadow of a tip, tangent to the cone's base: the outline of a cone's shadow (section 5.1).
/// `touch` are the points of the base where they begin, `inward` their unit normals, towards the shadow. Index 0 lies left, looking from
/// the foot to the shadow.
struct Outline {
  std::array<Eigen::Vector2d, 2> touch;
  std::array<Eigen::Vector2d, 2> inward;
  Eigen::Vector2d backward;  ///< from the shadow to the foot: the sum of the normals.
  bool valid = false;        ///< the shadow of the tip lies outside the base.
};
Outline outline_of(const Eigen::Vector2d& foot, double radius_m, const Eigen::Vector2d& tip_shadow);

/// Is a point of the board within the outline or the base, widened by a margin?
inline bool within(const Outline& outline, const Eigen::Vector2d& foot, double radius_m, const Eigen::Vector2d& point,
                   double margin_m) {
  const Eigen::Vector2d from_foot = point - foot;
  const double reach = radius_m + margin_m;
  if (from_foot.squaredNorm() <= reach * reach) return true;
  if (!outline.valid || from_foot.dot(outline.backward) >= 0.0) return false;
  return (point - outline.touch[0]).dot(outline.inward[0]) >= -margin_m &&
         (point - outline.touch[1]).dot(outline.inward[1]) >= -margin_m;
}

/// From the board's border, where its brightness is no longer its own.
inline constexpr double kBoardMargin_m = 0.003;

/// Is a place of the board's plane on the board?
inline bool is_on_board(const Board& board, const Eigen::Vector2d& p_B) {
  return std::abs(p_B.x()) <= board.depth_m / 2 - kBoardMargin_m &&
         std::abs(p_B.y()) <= board.width_m / 2 - kBoardMargin_m;
}

/// Is it on the board, and not behind a cone? \param behind  what each cone hides from the camera.
bool is_seen(const Board& board, const std::array<Outline, kMostProbes>& behind, const Eigen::Vector2d& p_B);

}  // namespace cgsr::illumination
