#include "pipeline/calibration/mount.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <Eigen/SVD>
#include <opencv2/calib3d.hpp>

#include "pipeline/calibration/least_squares.h"

namespace cgsr::calibration {
namespace {

using geometry::Pose;

constexpr double kMaxRms_px = 2.0;
constexpr double kMaxRms_m = 0.10;
constexpr double kMinTurn_rad = 0.52;
constexpr double kMinWay_m = 0.3;
constexpr double kMinFirmness_m = 0.02;
constexpr std::size_t kFewestPairs = 6;
/// A radian counts as so many metres: what is seen 2 m away moves by that.
constexpr double kLever_m = 2.0;

Pose stepped(const Pose& X, const Eigen::VectorXd& parameters, Eigen::Index first) {
  return geometry::moved(X, geometry::Vector6d(parameters.segment<6>(first)));
}

Pose board_in_camera(const BoardView& view, const Board& board, const geometry::Camera& camera) {
  const cv::Mat K = (cv::Mat_<double>(3, 3) << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1);
  const cv::Mat distortion = (cv::Mat_<double>(1, 5) << camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
  cv::Mat turn;
  cv::Mat place;
  cv::solvePnP(board.points(), view.corners, K, distortion, turn, place, false, cv::SOLVEPNP_IPPE);
  Pose X_CB = Pose::Identity();
  X_CB.linear() = geometry::rotation_of({turn.at<double>(0), turn.at<double>(1), turn.at<double>(2)});
  X_CB.translation() = Eigen::Vector3d(place.at<double>(0), place.at<double>(1), place.at<double>(2));
  return X_CB;
}

/// Pixels between corners and where the mount puts them.
Eigen::VectorXd corner_residuals(const Pose& X_RC, const std::vector<BoardView>& views, const std::vector<Pose>& X_RB,
                                 const Board& board, const geometry::Camera& camera) {
  constexpr double kBehind_px = 1e4;
  const std::vector<cv::Point3f> points = board.points();
  Eigen::VectorXd out(static_cast<Eigen::Index>(2 * points.size() * views.size()));
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Pose X_CB = X_RC.inverse() * X_RB[i];
    for (std::size_t j = 0; j < points.size(); ++j) {
      const Eigen::Vector3d p_B(static_cast<double>(points[j].x), static_cast<double>(points[j].y), 0.0);
      const auto pixel = camera.pixel_of(X_CB * p_B);
      const cv::Point2f& seen = views[i].corners[j];
      out[row++] = pixel ? pixel->x() - static_cast<double>(seen.x) : kBehind_px;
      out[row++] = pixel ? pixel->y() - static_cast<double>(seen.y) : kBehind_px;
    }
  }
  return out;
}

/// What floor and linear equations say before anything is refined.
struct Start {
  Pose X_WO = Pose::Identity();
  Pose X_RC = Pose::Identity();
  double firmness_m =
      0.0;  ///< how far the poses are from leaving the answer open, which those on one circle or one line do.
};

/// On the floor, p_WC = t + R(a) (p_OR + R(h) m) is linear in t, in (cos a, sin a) and in R(a) m.
Start start_from_poses(const std::vector<Pose>& X_WC, const std::vector<Pose>& X_OR) {
  const auto n = static_cast<Eigen::Index>(X_WC.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 6);
  Eigen::VectorXd b(2 * n);
  double height = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Pose& odometry = X_OR[static_cast<std::size_t>(i)];
    const Eigen::Vector3d& camera = X_WC[static_cast<std::size_t>(i)].translation();
    const double x = odometry.translation().x();
    const double y = odometry.translation().y();
    const double c = std::cos(geometry::heading_of(odometry));
    const double s = std::sin(geometry::heading_of(odometry));
    A.row(2 * i) << 1.0, 0.0, x, -y, c, -s;
    A.row(2 * i + 1) << 0.0, 1.0, y, x, s, c;
    b.segment<2>(2 * i) = camera.head<2>();
    height += camera.z() / static_cast<double>(n);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> equations(A, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd v = equations.solve(b);
  const double a = std::atan2(v[3], v[2]);
  Start start;
  start.firmness_m = equations.singularValues()[5] / std::sqrt(static_cast<double>(n));
  start.X_WO = geometry::pose_on_floor(v[0], v[1], a);
  const Eigen::Vector2d m(std::cos(a) * v[4] + std::sin(a) * v[5], -std::sin(a) * v[4] + std::cos(a) * v[5]);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < X_WC.size(); ++i) sum += ((start.X_WO * X_OR[i]).inverse() * X_WC[i]).linear();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d sign = Eigen::Matrix3d::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  start.X_RC.linear() = svd.matrixU() * sign * svd.matrixV().transpose();
  start.X_RC.translation() = Eigen::Vector3d(m.x(), m.y(), height);
  return start;
}

}  // namespace

Pose board_on_floor(double x_m, double y_m, double heading_rad) {
  Pose X_RB = Pose::Identity();
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  X_RB.linear().col(0) = Eigen::Vector3d(c, s, 0.0);
  X_RB.linear().col(1) = Eigen::Vector3d(s, -c, 0.0);
  X_RB.linear().col(2) = Eigen::Vector3d(0.0, 0.0, -1.0);
  X_RB.translation() = Eigen::Vector3d(x_m, y_m, 0.0);
  return X_RB;
}

Result<Mount> mount_from_boards(const std::vector<BoardView>& views, const std::vector<Pose>& X_RB, const Board& board,
                                const geometry::Camera& camera) {
  if (views.empty() || views.size() != X_RB.size()) {
    return fail(fmt::format("{} views of the board with {} known poses of it; expected one and as many of both",
                            views.size(), X_RB.size()));
  }
  if (!board.has_one_frame()) {
    return fail(fmt::format(
        "a board of {}x{} inner corners looks the same when it is turned by half a round; expected one odd and one "
        "even number, such as 9x6",
        board.columns, board.rows));
  }
  const auto residuals_of = [&](const Pose& X) { return corner_residuals(X, views, X_RB, board, camera); };
  Pose start = Pose::Identity();
  double min = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    Pose X_RC = Pose::Identity();
    try {
      X_RC = X_RB[i] * board_in_camera(views[i], board, camera).inverse();
    } catch (const cv::Exception& wrong) {
      return fail(fmt::format("image {}: the board has no pose: {}", views[i].image, wrong.err));
    }
    const double cost = residuals_of(X_RC).cwiseAbs().cwiseMin(100.0).sum();
    if (i == 0 || cost < min) {
      min = cost;
      start = X_RC;
    }
  }
  const Fit fit = fit_least_squares([&](const Eigen::VectorXd& v) { return residuals_of(stepped(start, v, 0)); },
                                    Eigen::VectorXd::Zero(6));
  Mount mount;
  mount.X_RC = geometry::normalized(stepped(start, fit.parameters, 0));
  for (Eigen::Index i = 0; i < 3; ++i) {
    mount.sigma_m[i] = fit.sigma(i);
    mount.sigma_rad[i] = fit.sigma(3 + i);
  }
  mount.rms = fit.rms * std::sqrt(2.0);  // of the distance, not of each coordinate
  const Eigen::Index per_view = 2 * static_cast<Eigen::Index>(board.columns * board.rows);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto part = fit.residuals.segment(static_cast<Eigen::Index>(i) * per_view, per_view);
    mount.view_rms.push_back(std::sqrt(2.0 * part.squaredNorm() / static_cast<double>(per_view)));
  }
  if (!(mount.rms <= kMaxRms_px)) {
    const auto worst = static_cast<std::size_t>(std::max_element(mount.view_rms.begin(), mount.view_rms.end()) -
                                                mount.view_rms.begin());
    return fail(fmt::format(
        "corners lie {:.1f} px (RMS) off; expected at most {:.0f}: the stated poses of the board contradict the "
        "images, most of all image {} ({:.1f} px)",
        mount.rms, kMaxRms_px, views[worst].image, mount.view_rms[worst]));
  }
  return mount;
}

namespace {

// A drive that neither turns nor moves leaves the mount open.
Result<void> check_drive(const std::vector<Pose>& X_OR) {
  double turn = 0.0;
  double way = 0.0;
  for (const Pose& X : X_OR) {
    turn = std::max(turn, geometry::vector_of(X_OR[0].linear().transpose() * X.linear()).norm());
    way = std::max(way, (X.translation() - X_OR[0].translation()).norm());
  }
  if (turn < kMinTurn_rad || way < kMinWay_m) {
    return fail(fmt::format(
        "the robot turned by {:.0f} degrees and drove {:.2f} m; expected at least {:.0f} degrees and {} m: without, "
        "where the camera is and which way it looks cannot be told apart",
        turn * 180.0 / 3.14159265, way, kMinTurn_rad * 180.0 / 3.14159265, kMinWay_m));
  }
  return {};
}

Fit fit_mount(const std::vector<Pose>& X_WC, const std::vector<Pose>& X_OR, const Start& start) {
  const auto n = static_cast<Eigen::Index>(X_WC.size());
  const auto residuals_at = [&](const Eigen::VectorXd& v) {
    const Pose X_RC = stepped(start.X_RC, v, 0);
    const Pose X_WO = geometry::pose_on_floor(v[6], v[7], v[8]) * start.X_WO;
    Eigen::VectorXd out(6 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      geometry::Vector6d step = geometry::step_between(X_WO * X_OR[k] * X_RC, X_WC[k]);
      step.tail<3>() *= kLever_m;
      out.segment<6>(6 * i) = step;
    }
    return out;
  };
  return fit_least_squares(residuals_at, Eigen::VectorXd::Zero(9));
}

void fill_errors(const Fit& fit, Eigen::Index n, Mount& mount) {
  double squares_m = 0.0;
  double squares_rad = 0.0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double off_m = fit.residuals.segment<3>(6 * i).norm();
    const double off_rad = fit.residuals.segment<3>(6 * i + 3).norm() / kLever_m;
    mount.view_rms.push_back(off_m);
    squares_m += off_m * off_m;
    squares_rad += off_rad * off_rad;
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    mount.sigma_m[i] = fit.sigma(i);
    mount.sigma_rad[i] = fit.sigma(3 + i);
  }
  mount.rms = std::sqrt(squares_m / static_cast<double>(n));
  mount.rms_rad = std::sqrt(squares_rad / static_cast<double>(n));
}

}  // namespace

Result<Mount> mount_from_poses(const std::vector<Pose>& X_WC, const std::vector<Pose>& X_OR) {
  if (X_WC.size() < kFewestPairs || X_WC.size() != X_OR.size()) {
    return fail(fmt::format("{} camera poses and {} of the odometry; expected at least {} and as many of both",
                            X_WC.size(), X_OR.size(), kFewestPairs));
  }
  if (auto checked = check_drive(X_OR); !checked) return tl::unexpected(checked.error());
  const Start start = start_from_poses(X_WC, X_OR);
  if (!(start.firmness_m >= kMinFirmness_m)) {
    return fail(fmt::format(
        "the robot drove along one circle ({:.3f} m off; expected at least {}): drive bends to both sides and straight "
        "pieces, otherwise where the camera is and which way it looks cannot be told apart",
        start.firmness_m, kMinFirmness_m));
  }
  const Fit fit = fit_mount(X_WC, X_OR, start);
  Mount mount;
  mount.X_RC = geometry::normalized(stepped(start.X_RC, fit.parameters, 0));
  fill_errors(fit, static_cast<Eigen::Index>(X_WC.size()), mount);
  if (!(mount.rms <= kMaxRms_m)) {
    return fail(fmt::format(
        "the poses lie {:.1f} cm (RMS) off the odometry; expected at most {:.0f}: take a shorter drive, or calibrate "
        "the odometry first",
        100.0 * mount.rms, 100.0 * kMaxRms_m));
  }
  return mount;
}

std::string mount_as_toml(const Mount& mount) {
  const Eigen::Vector3d& p = mount.X_RC.translation();
  Eigen::Quaterniond q(mount.X_RC.linear());
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  constexpr double kDegrees = 180.0 / 3.14159265358979;
  return fmt::format(
      "# The robot's frame: x forward, y left, z up, metres. The mount is the pose of the camera (x right, y down, z "
      "forward) in it.\n"
      "[mount]\nposition_m = [ {:.6f}, {:.6f}, {:.6f} ]\nquaternion_wxyz = [ {:.9f}, {:.9f}, {:.9f}, {:.9f} ]\n"
      "# standard errors along and about the robot's axes\n"
      "# sigma_m = [ {:.4f}, {:.4f}, {:.4f} ]\n# sigma_deg = [ {:.3f}, {:.3f}, {:.3f} ]\n",
      p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), mount.sigma_m.x(), mount.sigma_m.y(), mount.sigma_m.z(),
      kDegrees * mount.sigma_rad.x(), kDegrees * mount.sigma_rad.y(), kDegrees * mount.sigma_rad.z());
}

}  // namespace cgsr::calibration
