#include "pipeline/calibration/probes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "pipeline/calibration/least_squares.h"
#include "pipeline/illumination/lamp.h"

namespace cgsr::calibration {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kMaxRms_m = 0.004;
constexpr double kMinSigma_m = 0.0003;  // of a shadow: no image is better than this

// Of one shadow, whitened: what the unknowns do not explain.
struct Seen {
  std::size_t probe;
  Vector2d p_BS;
  Eigen::Matrix2d whiten;
  Vector3d p_BL;
};

// Unknowns: tips 0..2 and 3..5, the board's turn 6..8; metres and radians.
Vector2d off(const illumination::Board& board, const Seen& seen, const VectorXd& x) {
  const Vector3d turn = x.segment<3>(6);
  const Vector3d p_BL = geometry::rotation_of(-turn) * seen.p_BL;
  const Vector3d tip = board.probe[seen.probe].p_BA + x.segment<3>(3 * static_cast<Eigen::Index>(seen.probe));
  return seen.p_BS - illumination::shadow_of(p_BL, tip).p_BS;
}

std::string three(const Vector3d& v) {
  return fmt::format("[ {:.6f}, {:.6f}, {:.6f} ]", v.x(), v.y(), v.z());
}
std::string three(const std::array<double, 3>& v) {
  return three(Vector3d(v[0], v[1], v[2]));
}

// Of several shadows of a probe the one that this lamp throws. \return nullptr: none has both lines.
const illumination::ProbeShadow* shadow_of_lamp(const illumination::ShadowFinder::Found& found, const Vector3d& p_BL,
                                                const Vector3d& p_BA) {
  const illumination::ProbeShadow* nearest = nullptr;
  for (int k = 0; k < found.count; ++k) {
    const auto& shadow = found.shadow[static_cast<std::size_t>(k)];
    const Vector2d expected = illumination::shadow_of(p_BL, p_BA).p_BS;
    if (shadow.lines == 2 &&
        (nearest == nullptr || (shadow.p_BS - expected).norm() < (nearest->p_BS - expected).norm()))
      nearest = &shadow;
  }
  return nearest;
}

// Adds the shadows of a view in which the board was registered.
Result<void> add_shadows(const illumination::Board& board, const ProbeView& view, const Vector3d& p_WL,
                         std::vector<Seen>& seen) {
  const Vector3d p_BL = board.X_RB.inverse() * (view.X_WR.inverse() * p_WL);
  for (std::size_t i = 0; i < static_cast<std::size_t>(board.probes); ++i) {
    if (p_BL.z() < board.probe[i].p_BA.z() + 0.05) {
      return fail(fmt::format("the lamp at ({:.3f}, {:.3f}, {:.3f}) m is not above the probes' tips", p_WL.x(),
                              p_WL.y(), p_WL.z()));
    }
    const auto* shadow = shadow_of_lamp(view.observation.probe[i], p_BL, board.probe[i].p_BA);
    if (shadow == nullptr) continue;
    Eigen::Matrix2d V =
        shadow->covariance + shadow->J_pose * view.observation.registration.covariance * shadow->J_pose.transpose();
    V.diagonal().array() += kMinSigma_m * kMinSigma_m;
    const Eigen::Matrix2d L = V.llt().matrixL();
    seen.push_back({i, shadow->p_BS, L.inverse(), p_BL});
  }
  return {};
}

double rms_of(const illumination::Board& board, const std::vector<Seen>& seen, const VectorXd& x) {
  double sum = 0.0;
  for (const Seen& one : seen) sum += off(board, one, x).squaredNorm();
  return std::sqrt(sum / static_cast<double>(seen.size()));
}

Fit fit_board(const illumination::Board& board, const std::vector<Seen>& seen) {
  const double tip_sigma_m = std::max(1e-4, 2.0 * board.place_sigma_m);
  const double turn_sigma = std::max(1e-4, board.turn_sigma_rad);
  const auto residuals_at = [&](const VectorXd& x) {
    VectorXd r(static_cast<Eigen::Index>(2 * seen.size()) + 9);
    Eigen::Index row = 0;
    for (const Seen& one : seen) {
      r.segment<2>(row) = one.whiten * off(board, one, x);
      row += 2;
    }
    r.segment<6>(row) = x.head<6>() / tip_sigma_m;
    r.tail<3>() = x.tail<3>() / turn_sigma;
    return r;
  };
  return fit_least_squares(residuals_at, VectorXd(VectorXd::Zero(9)));
}

// The board turned about its middle, tips and feet with it; then each tip by its own error.
// \param step  mean step from the camera's stated pose on the board to the registered one.
void fill(const illumination::Board& board, const Fit& fit, const geometry::Vector6d& step, ProbeCalibration& out) {
  const geometry::Pose X_RB = board.X_RB;
  geometry::Pose turned = X_RB;
  turned.linear() = X_RB.linear() * geometry::rotation_of(fit.parameters.tail<3>());
  const Eigen::AngleAxisd about(turned.linear());
  const Vector3d turn_R = about.angle() * kDegPerRad * about.axis();
  out.board.turn_deg = {turn_R.x(), turn_R.y(), turn_R.z()};
  for (std::size_t i = 0; i < static_cast<std::size_t>(board.probes); ++i) {
    illumination::ProbeParameters& probe = i == 0 ? out.board.left : out.board.right;
    const auto row = static_cast<Eigen::Index>(3 * i);
    const Vector3d apex = turned * (board.probe[i].p_BA + fit.parameters.segment<3>(row));
    const Vector3d foot = turned * Vector3d(board.probe[i].foot_B.x(), board.probe[i].foot_B.y(), 0.0);
    probe.apex_m = {apex.x(), apex.y(), apex.z()};
    probe.foot_m = {foot.x(), foot.y(), foot.z()};
    for (Eigen::Index k = 0; k < 3; ++k) out.tip_sigma_m[i][k] = fit.sigma(row + k);
  }
  for (Eigen::Index k = 0; k < 3; ++k) out.turn_sigma_deg[k] = kDegPerRad * fit.sigma(6 + k);
  out.X_RC = turned * geometry::moved(board.X_BC, step);
}

}  // namespace

Result<ProbeCalibration> calibrate_probes(const illumination::Board& board,
                                          const illumination::BoardParameters& parameters,
                                          const std::vector<ProbeView>& views, const Vector3d& p_WL) {
  std::vector<Seen> seen;
  ProbeCalibration out;
  geometry::Vector6d step = geometry::Vector6d::Zero();
  for (const ProbeView& view : views) {
    if (!view.observation.registration.good) continue;
    step += geometry::step_between(board.X_BC, view.observation.registration.X_BC);
    ++out.views;
    if (auto added = add_shadows(board, view, p_WL, seen); !added) return tl::unexpected(added.error());
  }
  out.shadows = static_cast<int>(seen.size());
  if (seen.size() < 4) {
    return fail(
        fmt::format("{} shadows of probes in {} images, expected at least 4: the lamp shines from elsewhere, "
                    "or the probes are not in view",
                    seen.size(), views.size()));
  }
  const Fit fit = fit_board(board, seen);
  out.rms_before_m = rms_of(board, seen, VectorXd::Zero(9));
  out.rms_m = rms_of(board, seen, fit.parameters);
  if (out.rms_m > kMaxRms_m) {
    return fail(
        fmt::format("shadows fall {:.1f} mm (RMS) from where a lamp at ({:.3f}, {:.3f}, {:.3f}) m throws them, "
                    "expected at most {:.0f} mm: another lamp, or poses of other images",
                    1e3 * out.rms_m, p_WL.x(), p_WL.y(), p_WL.z(), 1e3 * kMaxRms_m));
  }
  out.board = parameters;
  fill(board, fit, step / std::max(1, out.views), out);
  return out;
}

std::string probes_as_toml(const ProbeCalibration& calibration) {
  const Vector3d& p = calibration.X_RC.translation();
  Eigen::Quaterniond q(calibration.X_RC.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const illumination::BoardParameters& board = calibration.board;
  std::string text = fmt::format(
      "# The robot's frame: x forward, y left, z up, metres. The mount is the pose of the camera (x right, y down, z "
      "forward) in it.\n[mount]\nposition_m = {}\nquaternion_wxyz = [ {:.9f}, {:.9f}, {:.9f}, {:.9f} ]\n\n"
      "# {} shadows in {} images fall {:.2f} mm (RMS) from where the lamp throws them, {:.2f} mm before\n[board]\n"
      "position_m = {}\nturn_deg = {}\nwidth_m = {:.6f}\ndepth_m = {:.6f}\n",
      three(p), q.w(), q.x(), q.y(), q.z(), calibration.shadows, calibration.views, 1e3 * calibration.rms_m,
      1e3 * calibration.rms_before_m, three(board.position_m), three(board.turn_deg), board.width_m, board.depth_m);
  for (int i = 0; i < board.probes; ++i) {
    const illumination::ProbeParameters& probe = i == 0 ? board.left : board.right;
    text += fmt::format("\n[[board.probe]]\napex_m = {}\nfoot_m = {}\nbase_radius_m = {:.6f}\n# apex sigma_m = {}\n",
                        three(probe.apex_m), three(probe.foot_m), probe.base_radius_m,
                        three(calibration.tip_sigma_m[static_cast<std::size_t>(i)]));
  }
  return text;
}

}  // namespace cgsr::calibration
