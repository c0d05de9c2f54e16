#include "pipeline/illumination/registration.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace cgsr::illumination {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Matrix6d;
using geometry::Vector6d;

constexpr int kMostPoints = 320;
constexpr int kMostReach_px = 16;
constexpr double kShare = 0.5;        // of what was measured wrongly, what one line does not share with its neighbours
constexpr double kNoise_px = 0.15;    // of one point, out of pixel noise
constexpr double kBelieved = 2.5;     // standard deviations by which a cone may stand elsewhere than measured
constexpr int kSteps = 2;             // of Gauss-Newton on what one round found
constexpr double kOtherStarts = 1.5;  // standard deviations of the mount
constexpr double kMostRms_px = 1.2;
constexpr double kGoodRms_px = 0.6;
constexpr double kLeastAgreeing = 0.6;  // of the points that were found

// One round of looking for edges. The first must bring them in from the mount's error, clutter and all, and needs no accuracy for it.
struct Round {
  double soft_px;  // what it takes for far off
  double sparser;  // than the parameters' spacing
};
constexpr std::array kRound{Round{6.0, 2.5}, Round{2.5, 2.0}, Round{0.8, 1.5}, Round{0.8, 1.0}};
constexpr int kRounds = static_cast<int>(kRound.size());

// A place on an expected line, and where its edge was found.
struct EdgePoint {
  Vector2d normal;   // in the image, unit
  double offset_px;  // of the edge along the normal, from where it was expected
  Vector6d J_pose;   // of that offset, by geometry::moved(X_BC, step)
  double sigma2_px;  // what it tells, its line's common error included
  double soft2_px;   // what is far off, squared
  double place_px;   // the calibration's own error, as it is seen here
  int feature;       // board 0, cones 1 and 2
};

// Brightness across an expected line, at whole pixels; the strongest change within reach, to a fraction of a pixel. `at` keeps the reach inside.
bool find_edge(const LumaView& image, const Vector2d& at, const Vector2d& normal, int reach, double min_contrast,
               double& offset_px) {
  std::array<float, 2 * kMostReach_px + 3> value;
  const int count = 2 * reach + 3;
  const auto dx = static_cast<float>(normal.x());
  const auto dy = static_cast<float>(normal.y());
  const float x = static_cast<float>(at.x()) - static_cast<float>(reach + 1) * dx;
  const float y = static_cast<float>(at.y()) - static_cast<float>(reach + 1) * dy;
  for (int i = 0; i < count; ++i) {
    const auto step = static_cast<float>(i);
    value[static_cast<std::size_t>(i)] = image.at(x + step * dx, y + step * dy);
  }
  int best = -1;
  float most = 0.0F;
  for (int i = 1; i + 1 < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    // Of two edges alike the nearer one: silhouette beside shadow.
    const float nearer = 1.0F - 0.03F * static_cast<float>(std::abs(i - reach - 1));
    const float score = std::abs(value[k + 1] - value[k - 1]) * nearer;
    if (score > most) {
      most = score;
      best = i;
    }
  }
  if (best < 2 || best + 2 >= count) return false;
  const auto change = [&value](int i) {
    const auto k = static_cast<std::size_t>(i);
    return std::abs(value[k + 1] - value[k - 1]);
  };
  const float middle = change(best);
  if (middle < static_cast<float>(min_contrast)) return false;
  const float before = change(best - 1);
  const float after = change(best + 1);
  const float bend = before - 2.0F * middle + after;
  if (bend >= 0.0F) return false;
  const float fraction = std::clamp(0.5F * (before - after) / bend, -1.0F, 1.0F);
  offset_px = best - reach - 1 + static_cast<double>(fraction);
  return true;
}

// Collects points along the lines that the camera should see.
class Collector {
 public:
  Collector(const Board& board, const RegistrationParameters& parameters, const LumaView& image, const BoardView& view,
            int reach, const Round& round, std::array<EdgePoint, kMostPoints>& points)
      : board_(board), image_(image), view_(view), reach_(reach), round_(round), points_(points) {
    spacing_px_ = parameters.spacing_px * round.sparser;
    min_contrast_ = parameters.min_contrast;
    for (int i = 0; i < board_.probes; ++i) {
      const Probe& probe = board_.probe[static_cast<std::size_t>(i)];
      behind_[static_cast<std::size_t>(i)] = outline_of(probe.foot_B, probe.radius_m, cast(view_.p_BC(), probe.p_BA));
    }
  }

  int collect() {
    const double x = board_.depth_m / 2;
    const double y = board_.width_m / 2;
    segment({x, -y, 0.0}, {x, y, 0.0}, 0);
    segment({-x, -y, 0.0}, {-x, y, 0.0}, 0);
    segment({-x, y, 0.0}, {x, y, 0.0}, 0);
    segment({-x, -y, 0.0}, {x, -y, 0.0}, 0);
    for (int i = 0; i < board_.probes; ++i) cone(i);
    return count_;
  }

 private:
  // Is a point of the board behind a cone?
  [[nodiscard]] bool hidden(const Vector2d& p_B) const {
    for (int i = 0; i < board_.probes; ++i) {
      const Probe& probe = board_.probe[static_cast<std::size_t>(i)];
      if (within(behind_[static_cast<std::size_t>(i)], probe.foot_B, probe.radius_m, p_B, 0.008)) return true;
    }
    return false;
  }

  void segment(const Vector3d& from, const Vector3d& to, int feature) {
    const Vector3d d = to - from;
    // As many points as the middle's resolution asks for; board lines are straight but for the lens.
    const auto middle = view_.derivative(from + 0.5 * d);
    if (!middle.in_front) return;
    const double length_px = (middle.J_point * d).norm();
    const int steps = std::clamp(static_cast<int>(length_px / spacing_px_), 2, 120);
    const int begin = count_;
    for (int i = 0; i < steps; ++i) {
      const Vector3d p_B = from + (i + 0.5) / steps * d;
      if (feature == 0 && hidden(p_B.head<2>())) continue;
      add(p_B, d, feature);
    }
    weigh(begin);
  }

  void cone(int index) {
    const Probe& probe = board_.probe[static_cast<std::size_t>(index)];
    const Outline& outline = behind_[static_cast<std::size_t>(index)];
    if (!outline.valid) return;
    const int feature = index + 1;
    for (const Vector2d& touch : outline.touch) {
      const Vector3d low(touch.x(), touch.y(), 0.0);
      const Vector3d up = probe.p_BA - low;
      segment(low + 0.06 * up, low + 0.94 * up, feature);
    }
    // The front of the base, between the two points where the silhouette begins, on the camera's side.
    const Vector2d forward = (cast(view_.p_BC(), probe.p_BA) - probe.foot_B).normalized();
    const double front = std::atan2(-forward.y(), -forward.x());
    constexpr int kArc = 8;
    const int begin = count_;
    for (int i = 0; i < kArc; ++i) {
      const double angle = front + (i - (kArc - 1) / 2.0) * (0.8 * std::numbers::pi / kArc);
      const Vector2d out(std::cos(angle), std::sin(angle));
      const Vector2d at = probe.foot_B + probe.radius_m * out;
      add({at.x(), at.y(), 0.0}, {-out.y(), out.x(), 0.0}, feature);
    }
    weigh(begin);
  }

  void add(const Vector3d& p_B, const Vector3d& along, int feature) {
    if (count_ >= kMostPoints) return;
    const auto d = view_.derivative(p_B);
    if (!d.in_front || !image_.holds(d.at.x(), d.at.y(), reach_ + 1.1)) return;
    const Vector2d tangent = d.J_point * along;
    const double length = tangent.norm();
    if (length < 1e-9) return;
    EdgePoint& point = points_[static_cast<std::size_t>(count_)];
    point.normal = Vector2d(-tangent.y(), tangent.x()) / length;
    if (!find_edge(image_, d.at, point.normal, reach_, min_contrast_, point.offset_px)) return;
    point.J_pose = (point.normal.transpose() * view_.pose_jacobian(d, p_B)).transpose();
    point.feature = feature;
    // How many pixels the calibration's own error is here.
    point.place_px = board_.place_sigma_m * d.J_point.norm() / std::numbers::sqrt2;
    ++count_;
  }

  // The points of one line err together by what was measured wrongly: all of them tell no more than one that errs so.
  void weigh(int begin) {
    const int number = count_ - begin;
    for (int i = begin; i < count_; ++i) {
      EdgePoint& point = points_[static_cast<std::size_t>(i)];
      const double own = kShare * point.place_px;
      point.sigma2_px = kNoise_px * kNoise_px + number * own * own;
      const double far = kBelieved * point.place_px;
      point.soft2_px = round_.soft_px * round_.soft_px + far * far;
    }
  }

  const Board& board_;
  const LumaView& image_;
  const BoardView& view_;
  int reach_;
  const Round& round_;
  std::array<EdgePoint, kMostPoints>& points_;
  std::array<Outline, kMostProbes> behind_;  // what the cones hide from the camera
  double spacing_px_ = 0.0;
  double min_contrast_ = 0.0;
  int count_ = 0;
};

void accumulate(Matrix6d& H, Vector6d& g, const Vector6d& j, double residual, double weight) {
  for (int a = 0; a < 6; ++a) {
    const double wa = weight * j[a];
    g[a] += wa * residual;
    for (int b = a; b < 6; ++b) H(a, b) += wa * j[b];
  }
}

Registration attempt(const Board& board, const RegistrationParameters& parameters, const LumaView& image,
                     const geometry::Pose& start, int first) {
  Registration result;
  result.X_BC = start;
  std::array<EdgePoint, kMostPoints> points;
  Vector6d prior;
  prior.head<3>().setConstant(1.0 / (board.mount_sigma_m * board.mount_sigma_m));
  prior.tail<3>().setConstant(1.0 / (board.mount_sigma_rad * board.mount_sigma_rad));
  for (int round = first; round < kRounds; ++round) {
    const double reach_px = round == 0   ? parameters.first_reach_px
                            : round == 1 ? 0.5 * (parameters.first_reach_px + parameters.next_reach_px)
                                         : parameters.next_reach_px;
    const int reach = std::min(kMostReach_px, static_cast<int>(std::ceil(reach_px)));
    const geometry::Pose X_round = result.X_BC;
    const BoardView view(board.camera, X_round);
    const Round& how = kRound[static_cast<std::size_t>(round)];
    const int count = Collector(board, parameters, image, view, reach, how, points).collect();
    if (count * how.sparser < parameters.min_points) return result;
    Vector6d total = Vector6d::Zero();
    for (int step = 0; step < kSteps; ++step) {
      Matrix6d H = prior.asDiagonal();
      Vector6d g = prior.cwiseProduct(geometry::step_between(geometry::moved(X_round, total), board.X_BC));
      double squares = 0.0;
      std::array<int, 3> agree{};
      for (int i = 0; i < count; ++i) {
        const EdgePoint& point = points[static_cast<std::size_t>(i)];
        const double residual = point.offset_px - point.J_pose.dot(total);
        const double robust = point.soft2_px / (point.soft2_px + residual * residual);
        accumulate(H, g, point.J_pose, residual, robust * robust / point.sigma2_px);
        if (residual * residual < 2.25 * point.soft2_px) {
          ++agree[static_cast<std::size_t>(point.feature)];
          squares += residual * residual;
        }
      }
      H = Matrix6d(H.selfadjointView<Eigen::Upper>());
      const Eigen::LLT<Matrix6d> solver(H);
      if (solver.info() != Eigen::Success) return result;
      total += solver.solve(g);
      if (step + 1 < kSteps) continue;
      result.covariance = solver.solve(Matrix6d::Identity());
      result.points = agree[0] + agree[1] + agree[2];
      result.cones = (agree[1] >= 8 ? 1 : 0) | (agree[2] >= 8 ? 2 : 0);
      result.rms_px = result.points > 0 ? std::sqrt(squares / result.points) : 0.0;
      result.good = result.points >= parameters.min_points && result.points >= kLeastAgreeing * count &&
                    result.cones != 0 && result.rms_px < kMostRms_px && round + 1 == kRounds;
    }
    result.X_BC = geometry::moved(X_round, total);
  }
  return result;
}

// Does it explain more of board and cones?
bool better(const Registration& a, const Registration& b) {
  if (a.good != b.good) return a.good;
  if (std::popcount(static_cast<unsigned>(a.cones)) != std::popcount(static_cast<unsigned>(b.cones)))
    return std::popcount(static_cast<unsigned>(a.cones)) > std::popcount(static_cast<unsigned>(b.cones));
  return a.points > b.points;
}

}  // namespace

Registration register_board(const Board& board, const RegistrationParameters& parameters, const LumaView& image,
                            const geometry::Pose& start, bool start_is_good) {
  if (start_is_good) return attempt(board, parameters, image, start, kRounds - 1);
  Registration best = attempt(board, parameters, image, board.X_BC, 0);
  const int all_cones = (1 << board.probes) - 1;
  if (best.good && best.cones == all_cones && best.rms_px < kGoodRms_px) return best;
  // A line beside the one that was meant took it: once more from all around, where the mount's own error may have brought the camera.
  for (const auto& [about_x, about_y] : {std::pair{1.0, 0.0},
                                         {-1.0, 0.0},
                                         {0.0, 1.0},
                                         {0.0, -1.0},
                                         {0.9, 0.9},
                                         {-0.9, 0.9},
                                         {0.9, -0.9},
                                         {-0.9, -0.9}}) {
    const Vector3d turn_C = kOtherStarts * board.mount_sigma_rad * Vector3d(about_x, about_y, 0.0);
    Vector6d step = Vector6d::Zero();
    step.tail<3>() = board.X_BC.linear() * turn_C;
    const Registration other = attempt(board, parameters, image, geometry::moved(board.X_BC, step), 1);
    if (better(other, best)) best = other;
    if (best.good && best.cones == all_cones && best.rms_px < kGoodRms_px) break;
  }
  return best;
}

}  // namespace cgsr::illumination
