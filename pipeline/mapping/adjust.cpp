#include "pipeline/mapping/adjust.h"

#include <array>
#include <cmath>

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

namespace cgsr::mapping {
namespace {

constexpr double kNearest_m = 0.05;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

/// The step of geometry::moved() for Ceres: X_WC = moved(X_WC_0, step).
struct SteppedCamera {
  Eigen::Matrix3d R_CW;
  Eigen::Vector3d p_WC;

  explicit SteppedCamera(const geometry::Pose& X_WC) : R_CW(X_WC.linear().transpose()), p_WC(X_WC.translation()) {}

  template <class T>
  [[nodiscard]] Vector3<T> in_camera(const Vector3<T>& p_W, const T* step) const {
    const Vector3<T> back(-step[3], -step[4], -step[5]);
    const Vector3<T> from = p_W - p_WC.cast<T>() - Eigen::Map<const Vector3<T>>(step);
    Vector3<T> turned;
    ceres::AngleAxisRotatePoint(back.data(), from.data(), turned.data());
    return R_CW.cast<T>() * turned;
  }
};

/// d1 and d2 of Eq. 4.1 in sigmas, of an edge's stretch between two corners that move.
struct LineDistances {
  SteppedCamera camera;
  LineMatch match;
  double fx, fy, cx, cy;

  template <class T>
  bool operator()(const T* a, const T* b, const T* step, T* residual) const {
    for (std::size_t i = 0; i < 2; ++i) {
      const T s(match.along.at(i));
      const Vector3<T> p_W = (T(1.0) - s) * Eigen::Map<const Vector3<T>>(a) + s * Eigen::Map<const Vector3<T>>(b);
      const Vector3<T> p_C = camera.in_camera<T>(p_W, step);
      if (!(p_C.z() > T(kNearest_m))) return false;
      const T u = fx * p_C.x() / p_C.z() + cx;
      const T v = fy * p_C.y() / p_C.z() + cy;
      residual[i] = (match.normal.x() * u + match.normal.y() * v - match.offset_px) / match.sigma_px;
    }
    return true;
  }
};

/// How far a corner lies from the end of the line that ends there, along it, in sigmas.
struct EndDistance {
  SteppedCamera camera;
  EndMatch match;
  double sigma_px;
  double fx, fy, cx, cy;

  template <class T>
  bool operator()(const T* corner, const T* step, T* residual) const {
    const Vector3<T> p_C = camera.in_camera<T>(Eigen::Map<const Vector3<T>>(corner), step);
    if (!(p_C.z() > T(kNearest_m))) return false;
    const T u = fx * p_C.x() / p_C.z() + cx;
    const T v = fy * p_C.y() / p_C.z() + cy;
    residual[0] = (match.direction.x() * u + match.direction.y() * v - match.offset_px) / sigma_px;
    return true;
  }
};

/// A corner stays about where it was measured.
struct Place {
  Eigen::Vector3d p;
  double sigma_m;
  template <class T>
  bool operator()(const T* corner, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = (corner[k] - p[k]) / sigma_m;
    return true;
  }
};

/// Two corners keep their distance, and move alike across it.
struct Together {
  Eigen::Vector3d between;
  Eigen::Matrix3d root;  ///< of the information.
  explicit Together(const Tie& tie, const Eigen::Vector3d& d) : between(d) {
    const double length = d.norm();
    const Eigen::Vector3d along = length > 0.0 ? Eigen::Vector3d(d / length) : Eigen::Vector3d::Zero();
    root = (Eigen::Matrix3d::Identity() - along * along.transpose()) / tie.across_m +
           along * along.transpose() / tie.along_m;
  }
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    Vector3<T> off;
    for (int k = 0; k < 3; ++k) off[k] = b[k] - a[k] - between[k];
    Eigen::Map<Vector3<T>>(residual, 3) = root.cast<T>() * off;
    return true;
  }
};

/// A corner keeps its distance from the triangle that it lies on.
struct StaysOn {
  Contact contact;
  double distance_m;
  double sigma_m;
  template <class T>
  bool operator()(const T* p, const T* a, const T* b, const T* c, T* residual) const {
    using Map = Eigen::Map<const Vector3<T>>;
    const Vector3<T> on = contact.weights[0] * Map(a) + contact.weights[1] * Map(b) + contact.weights[2] * Map(c);
    residual[0] = (contact.normal.cast<T>().dot(Map(p) - on) - distance_m) / sigma_m;
    return true;
  }
};

/// The given pose: linear in the step, which is small against it.
struct GivenPose {
  geometry::Vector6d to_given;
  geometry::Matrix6d root;  ///< of the information.
  template <class T>
  bool operator()(const T* step, T* residual) const {
    Eigen::Matrix<T, 6, 1> off;
    for (int k = 0; k < 6; ++k) off[k] = step[k] - to_given[k];
    Eigen::Map<Eigen::Matrix<T, 6, 1>>(residual, 6) = root.cast<T>() * off;
    return true;
  }
};

/// The errors of given poses that follow each other, a stationary Gauss-Markov sequence: the second is what is left of the first, and what is new
///   e_i = keep e_(i-1) + N(0, (1 - keep^2) S)
struct LastingError {
  geometry::Vector6d to_before, to_now;
  geometry::Matrix6d root;  ///< of the information of what is new in the second.
  double keep;
  template <class T>
  bool operator()(const T* before, const T* now, T* residual) const {
    Eigen::Matrix<T, 6, 1> off;
    for (int k = 0; k < 6; ++k) off[k] = (to_now[k] - now[k]) - keep * (to_before[k] - before[k]);
    Eigen::Map<Eigen::Matrix<T, 6, 1>>(residual, 6) = root.cast<T>() * off;
    return true;
  }
};

/// Odometry between two images.
struct Odometry {
  geometry::Pose X_WA, X_WB, X_AB;
  double sigma_m, sigma_rad;
  template <class T>
  bool operator()(const T* a, const T* b, T* residual) const {
    const SteppedCamera before(X_WA);
    const Vector3<T> p_WB = X_WB.translation().cast<T>() + Eigen::Map<const Vector3<T>>(b);
    const Vector3<T> p_AB = before.in_camera<T>(p_WB, a);
    Eigen::Map<Vector3<T>>(residual, 3) = (p_AB - X_AB.translation().cast<T>()) / T(sigma_m);
    Eigen::Matrix<T, 3, 3> turn_a, turn_b;
    ceres::AngleAxisToRotationMatrix(a + 3, turn_a.data());
    ceres::AngleAxisToRotationMatrix(b + 3, turn_b.data());
    const Eigen::Matrix<T, 3, 3> R_AB =
        (turn_a * X_WA.linear().cast<T>()).transpose() * turn_b * X_WB.linear().cast<T>();
    const Eigen::Matrix<T, 3, 3> off = X_AB.linear().transpose().cast<T>() * R_AB;
    residual[3] = (off(2, 1) - off(1, 2)) / T(2.0 * sigma_rad);  // the sine of the turn, which is small
    residual[4] = (off(0, 2) - off(2, 0)) / T(2.0 * sigma_rad);
    residual[5] = (off(1, 0) - off(0, 1)) / T(2.0 * sigma_rad);
    return true;
  }
};

template <class Residual, int kCount, int... kSizes>
ceres::CostFunction* cost(Residual residual) {
  return new ceres::AutoDiffCostFunction<Residual, kCount, kSizes...>(new Residual(std::move(residual)));
}

/// The problem as Ceres takes it.
class Adjustment {
 public:
  Adjustment(const ElasticMap& map, std::vector<Eigen::Vector3d>& corners, std::span<View> views,
             const RefineParameters& parameters)
      : map_(&map), corners_(&corners), views_(views), parameters_(&parameters), steps_(views.size()) {
    for (auto& step : steps_) step.fill(0.0);
  }

  void add_map() {
    const auto& measured = map_->measured();
    for (std::size_t i = 0; i < measured.size(); ++i) {
      problem_.AddResidualBlock(cost<Place, 3, 3>({measured[i], map_->sigmas()[i]}), nullptr, corner(i));
    }
    for (const Tie& tie : map_->ties()) {
      problem_.AddResidualBlock(cost<Together, 3, 3, 3>(Together(tie, measured[tie.b] - measured[tie.a])), nullptr,
                                corner(tie.a), corner(tie.b));
    }
    for (const Contact& contact : map_->contacts()) {
      const auto& [a, b, c] = contact.on;
      if (a == b || b == c || a == c || contact.corner == a || contact.corner == b || contact.corner == c) continue;
      const Eigen::Vector3d on =
          contact.weights[0] * measured[a] + contact.weights[1] * measured[b] + contact.weights[2] * measured[c];
      const double distance = contact.normal.dot(measured[contact.corner] - on);
      problem_.AddResidualBlock(cost<StaysOn, 1, 3, 3, 3, 3>({contact, distance, parameters_->contact_sigma_m}),
                                new ceres::CauchyLoss(parameters_->robust), corner(contact.corner), corner(a),
                                corner(b), corner(c));
    }
  }

  void add_poses() {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const View& view = views_[i];
      add_given(i);
      if (i == 0 || !view.X_CB) continue;
      const double way = view.X_CB->translation().norm();
      const double turn = Eigen::AngleAxisd(view.X_CB->linear()).angle();
      const double sigma_m = std::hypot(parameters_->odometry_m, parameters_->odometry_share * way);
      const double sigma_rad = std::hypot(parameters_->odometry_rad, parameters_->odometry_turn_share * turn);
      problem_.AddResidualBlock(
          cost<Odometry, 6, 6, 6>({views_[i - 1].X_WC, view.X_WC, *view.X_CB, sigma_m, sigma_rad}), nullptr,
          step(i - 1), step(i));
    }
  }

  void add_given(std::size_t i) {
    const View& view = views_[i];
    const geometry::Vector6d to_given = geometry::step_between(view.X_WC, view.given.X_WC);
    const geometry::Matrix6d information = view.given.covariance.inverse();
    if (i == 0) {
      problem_.AddResidualBlock(cost<GivenPose, 6, 6>({to_given, information.llt().matrixU()}), nullptr, step(i));
      return;
    }
    const View& before = views_[i - 1];
    const double images = static_cast<double>(std::max<std::int64_t>(1, view.number - before.number));
    const double keep = std::exp(-2.0 * images / std::max(1.0, parameters_->correlated_images));
    const geometry::Matrix6d root = (information / (1.0 - keep * keep)).llt().matrixU();
    problem_.AddResidualBlock(
        cost<LastingError, 6, 6, 6>({geometry::step_between(before.X_WC, before.given.X_WC), to_given, root, keep}),
        nullptr, step(i - 1), step(i));
  }

  void add_matches(std::span<const LineMatch> matches, const geometry::Camera& camera) {
    for (const LineMatch& match : matches) {
      const auto [a, b] = map_->ends_of(match.edge);
      if (a == b) continue;
      auto* loss =
          new ceres::ScaledLoss(new ceres::CauchyLoss(parameters_->robust), match.weight, ceres::TAKE_OWNERSHIP);
      problem_.AddResidualBlock(
          cost<LineDistances, 2, 3, 3, 6>(
              {SteppedCamera(views_[match.view].X_WC), match, camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}),
          loss, corner(a), corner(b), step(match.view));
    }
  }

  void add_ends(std::span<const EndMatch> ends, const geometry::Camera& camera) {
    for (const EndMatch& match : ends) {
      auto* loss =
          new ceres::ScaledLoss(new ceres::CauchyLoss(parameters_->end_robust), match.weight, ceres::TAKE_OWNERSHIP);
      problem_.AddResidualBlock(
          cost<EndDistance, 1, 3, 6>({SteppedCamera(views_[match.view].X_WC), match, parameters_->end_sigma_px,
                                      camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px}),
          loss, corner(match.corner), step(match.view));
    }
  }

  Adjusted solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = parameters_->max_steps;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const geometry::Vector6d moved = Eigen::Map<const geometry::Vector6d>(steps_[i].data());
      views_[i].X_WC = geometry::normalized(geometry::moved(views_[i].X_WC, moved));
    }
    Adjusted adjusted;
    adjusted.solved = summary.IsSolutionUsable();
    adjusted.cost_before = summary.initial_cost;
    adjusted.cost_after = summary.final_cost;
    return adjusted;
  }

  /// Of each corner, out of the inverse of the normal equations' matrix.
  std::vector<double> sigmas() {
    ceres::Problem::EvaluateOptions options;
    for (std::size_t i = 0; i < corners_->size(); ++i) options.parameter_blocks.push_back(corner(i));
    for (std::size_t i = 0; i < steps_.size(); ++i) options.parameter_blocks.push_back(step(i));
    ceres::CRSMatrix J;
    if (!problem_.Evaluate(options, nullptr, nullptr, nullptr, &J)) return {};
    const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor, int>> jacobian(
        J.num_rows, J.num_cols, static_cast<int>(J.values.size()), J.rows.data(), J.cols.data(), J.values.data());
    const Eigen::SparseMatrix<double> normal = Eigen::SparseMatrix<double>(jacobian.transpose()) * jacobian;
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(normal);
    if (factor.info() != Eigen::Success) return {};
    std::vector<double> sigmas(corners_->size());
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(J.num_cols, 3);
    for (std::size_t i = 0; i < corners_->size(); ++i) {
      const auto row = static_cast<Eigen::Index>(3 * i);
      unit.block<3, 3>(row, 0).setIdentity();
      const Eigen::MatrixXd column = factor.solve(unit);
      unit.block<3, 3>(row, 0).setZero();
      sigmas[i] = std::sqrt(std::max(0.0, column.block<3, 3>(row, 0).trace() / 3.0));
    }
    return sigmas;
  }

 private:
  [[nodiscard]] double* corner(std::size_t i) { return (*corners_)[i].data(); }
  [[nodiscard]] double* step(std::size_t i) { return steps_[i].data(); }

  const ElasticMap* map_;
  std::vector<Eigen::Vector3d>* corners_;
  std::span<View> views_;
  const RefineParameters* parameters_;
  std::vector<std::array<double, 6>> steps_;
  ceres::Problem problem_;
};

}  // namespace

Adjusted adjust(const ElasticMap& map, std::vector<Eigen::Vector3d>& corners, std::span<View> views,
                std::span<const LineMatch> matches, std::span<const EndMatch> ends, const geometry::Camera& camera,
                const RefineParameters& parameters, bool with_sigmas) {
  Adjustment adjustment(map, corners, views, parameters);
  adjustment.add_map();
  adjustment.add_poses();
  adjustment.add_matches(matches, camera);
  adjustment.add_ends(ends, camera);
  Adjusted adjusted = adjustment.solve();
  if (with_sigmas) adjusted.sigma_m = adjustment.sigmas();
  return adjusted;
}

}  // namespace cgsr::mapping
