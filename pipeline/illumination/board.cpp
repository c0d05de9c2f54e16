#include "pipeline/illumination/board.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Geometry>

namespace cgsr::illumination {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kLeastDepth_m = 1e-6;
constexpr double kConeMargin_m = 0.0013;

Vector3d vector(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

std::string words(const Vector3d& v) {
  return fmt::format("({:.3f}, {:.3f}, {:.3f})", v.x(), v.y(), v.z());
}

}  // namespace

Result<Board> make_board(const BoardParameters& parameters, const geometry::Pose& X_RC,
                         const geometry::Camera& camera) {
  if (parameters.probes == 0) return fail("probes.board.probes = 0: the robot carries no probes");
  Board board;
  board.X_RB.linear() = geometry::rotation_of(vector(parameters.turn_deg) * kRadPerDeg);
  board.X_RB.translation() = vector(parameters.position_m);
  const geometry::Pose X_BR = board.X_RB.inverse();
  board.X_BC = X_BR * X_RC;
  board.camera = camera;
  board.width_m = parameters.width_m;
  board.depth_m = parameters.depth_m;
  board.probes = parameters.probes;
  board.place_sigma_m = parameters.place_sigma_m;
  board.turn_sigma_rad = parameters.turn_sigma_deg * kRadPerDeg;
  board.mount_sigma_m = parameters.mount_sigma_m;
  board.mount_sigma_rad = parameters.mount_sigma_deg * kRadPerDeg;
  const BoardView view(camera, board.X_BC);
  const auto in_image = [&](const Vector3d& p_B) {
    const auto pixel = view.pixel(p_B);
    return pixel.in_front && pixel.at.x() >= 0.0 && pixel.at.y() >= 0.0 && pixel.at.x() <= camera.width_px - 1 &&
           pixel.at.y() <= camera.height_px - 1;
  };
  for (int i = 0; i < board.probes; ++i) {
    const ProbeParameters& from = i == 0 ? parameters.left : parameters.right;
    const char* const name = i == 0 ? "left" : "right";
    Probe& probe = board.probe[static_cast<std::size_t>(i)];
    probe.p_BA = X_BR * vector(from.apex_m);
    const Vector3d foot_B = X_BR * vector(from.foot_m);
    probe.foot_B = foot_B.head<2>();
    probe.radius_m = from.base_radius_m;
    if (probe.p_BA.z() < 0.005) {
      return fail(fmt::format("probes.board.{}.apex_m = {}: {:.3f} m above the board, expected at least 0.005", name,
                              words(vector(from.apex_m)), probe.p_BA.z()));
    }
    if (std::abs(foot_B.z()) > 0.01 || std::abs(foot_B.x()) > board.depth_m / 2 ||
        std::abs(foot_B.y()) > board.width_m / 2) {
      return fail(fmt::format("probes.board.{}.foot_m = {}: not on the board", name, words(vector(from.foot_m))));
    }
    if (view.p_BC().z() < probe.p_BA.z() + 0.01) {
      return fail(fmt::format(
          "the camera is {:.3f} m above the board, and the {} probe {:.3f} m high: it does not look down on it",
          view.p_BC().z(), name, probe.p_BA.z()));
    }
    if (!in_image(probe.p_BA) || !in_image(foot_B)) {
      return fail(fmt::format(
          "the {} probe is not in the camera's view: camera, mount and board do not belong together", name));
    }
  }
  return board;
}

BoardView::BoardView(const geometry::Camera& camera, const geometry::Pose& X_BC)
    : camera_(camera), R_CB_(X_BC.linear().transpose()), p_BC_(X_BC.translation()) {}

BoardView::Pixel BoardView::pixel(const Vector3d& p_B) const {
  const Vector3d p_C = R_CB_ * (p_B - p_BC_);
  Pixel pixel;
  pixel.in_front = p_C.z() > kLeastDepth_m;
  if (!pixel.in_front) return pixel;
  const double x = p_C.x() / p_C.z();
  const double y = p_C.y() / p_C.z();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (camera_.k1 + r2 * (camera_.k2 + r2 * camera_.k3));
  const double xy2 = 2.0 * x * y;
  pixel.at.x() = camera_.fx_px * (x * radial + camera_.p1 * xy2 + camera_.p2 * (r2 + 2.0 * x * x)) + camera_.cx_px;
  pixel.at.y() = camera_.fy_px * (y * radial + camera_.p1 * (r2 + 2.0 * y * y) + camera_.p2 * xy2) + camera_.cy_px;
  return pixel;
}

BoardView::Derivative BoardView::derivative(const Vector3d& p_B) const {
  const Vector3d p_C = R_CB_ * (p_B - p_BC_);
  Derivative d;
  d.in_front = p_C.z() > kLeastDepth_m;
  if (!d.in_front) return d;
  const double over_z = 1.0 / p_C.z();
  const double x = p_C.x() * over_z;
  const double y = p_C.y() * over_z;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (camera_.k1 + r2 * (camera_.k2 + r2 * camera_.k3));
  const double slope = 2.0 * (camera_.k1 + r2 * (2.0 * camera_.k2 + r2 * 3.0 * camera_.k3));  // d radial / d r2, twice
  const double xy2 = 2.0 * x * y;
  d.at.x() = camera_.fx_px * (x * radial + camera_.p1 * xy2 + camera_.p2 * (r2 + 2.0 * x * x)) + camera_.cx_px;
  d.at.y() = camera_.fy_px * (y * radial + camera_.p1 * (r2 + 2.0 * y * y) + camera_.p2 * xy2) + camera_.cy_px;
  const double xx = camera_.fx_px * (radial + x * x * slope + 2.0 * camera_.p1 * y + 6.0 * camera_.p2 * x);
  const double across = x * y * slope + 2.0 * camera_.p1 * x + 2.0 * camera_.p2 * y;
  const double yy = camera_.fy_px * (radial + y * y * slope + 6.0 * camera_.p1 * y + 2.0 * camera_.p2 * x);
  const double xy = camera_.fx_px * across;
  const double yx = camera_.fy_px * across;
  for (int k = 0; k < 3; ++k) {
    const double dx = (R_CB_(0, k) - x * R_CB_(2, k)) * over_z;
    const double dy = (R_CB_(1, k) - y * R_CB_(2, k)) * over_z;
    d.J_point(0, k) = xx * dx + xy * dy;
    d.J_point(1, k) = yx * dx + yy * dy;
  }
  return d;
}

Eigen::Matrix<double, 2, 6> BoardView::pose_jacobian(const Derivative& derivative, const Vector3d& p_B) const {
  // p_C = R_CB exp(-w) (p_B - p_BC - step): by the place it is minus the derivative by the point, by the turn that times [p_B - p_BC]x.
  const Vector3d v = p_B - p_BC_;
  Eigen::Matrix<double, 2, 6> J;
  for (int row = 0; row < 2; ++row) {
    const double a = derivative.J_point(row, 0);
    const double b = derivative.J_point(row, 1);
    const double c = derivative.J_point(row, 2);
    J(row, 0) = -a;
    J(row, 1) = -b;
    J(row, 2) = -c;
    J(row, 3) = b * v.z() - c * v.y();
    J(row, 4) = c * v.x() - a * v.z();
    J(row, 5) = a * v.y() - b * v.x();
  }
  return J;
}

Vector2d cast(const Vector3d& from, const Vector3d& tip) {
  const double t = from.z() / (from.z() - tip.z());
  return (from + t * (tip - from)).head<2>();
}

Outline outline_of(const Vector2d& foot, double radius_m, const Vector2d& tip_shadow) {
  Outline outline;
  const Vector2d along = tip_shadow - foot;
  const double distance = along.norm();
  if (distance <= radius_m * 1.001) return outline;
  const Vector2d u = along / distance;
  const Vector2d left(-u.y(), u.x());
  const double s = radius_m / distance;  // sine of the half opening
  const double c = std::sqrt(1.0 - s * s);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    const Vector2d outward = s * u + sign * c * left;
    outline.touch[side] = foot + radius_m * outward;
    outline.inward[side] = -outward;
  }
  outline.backward = outline.inward[0] + outline.inward[1];
  outline.valid = true;
  return outline;
}

bool is_seen(const Board& board, const std::array<Outline, kMostProbes>& behind, const Vector2d& p_B) {
  if (!is_on_board(board, p_B)) return false;
  for (int i = 0; i < board.probes; ++i) {
    const Probe& probe = board.probe[static_cast<std::size_t>(i)];
    if (within(behind[static_cast<std::size_t>(i)], probe.foot_B, probe.radius_m, p_B, kConeMargin_m)) return false;
  }
  return true;
}

}  // namespace cgsr::illumination
