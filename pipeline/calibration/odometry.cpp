#include "pipeline/calibration/odometry.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "pipeline/calibration/least_squares.h"
#include "pipeline/stages/odometry_track.h"

namespace cgsr::calibration {
namespace {

using geometry::Pose;

constexpr double kPi = 3.14159265358979;
constexpr double kStretchTurn_rad = kPi / 3.0;
constexpr double kLeastWay_m = 2.0;
constexpr double kLeastTurn_rad = kPi;
constexpr int kFewestStretches = 3;
/// A radian of a stretch's end weighs as so many metres.
constexpr double kLever_m = 1.0;
/// What may be left per stretch: the ways themselves may slip by so much of their length, and found poses are off by some centimetres.
constexpr double kGreatestRms_m = 0.10;
constexpr double kGreatestRmsOfStretch = 0.05;
constexpr double kGreatestRms_rad = 5.0 * kPi / 180.0;
/// A robot that balances leans by less; a camera's frame, whose z points ahead, by about 90 degrees.
constexpr double kGreatestLean_rad = 30.0 * kPi / 180.0;
/// Wheels are off by a few percent: what is known no better than this corrects nothing.
constexpr double kGreatestSigma = 0.03;

double turn_between(const Pose& from, const Pose& to) {
  return geometry::heading_of(from.inverse() * to);
}

struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::vector<Stretch> stretches_of(const std::vector<Pose>& X_OR, double stretch_m) {
  std::vector<Stretch> out;
  std::size_t first = 0;
  double way = 0.0;
  double turn = 0.0;
  for (std::size_t i = 1; i < X_OR.size(); ++i) {
    way += (X_OR[i].translation() - X_OR[i - 1].translation()).norm();
    turn += std::abs(turn_between(X_OR[i - 1], X_OR[i]));
    if (way < stretch_m && turn < kStretchTurn_rad) continue;
    out.push_back({first, i});
    first = i;
    way = turn = 0.0;
  }
  return out;
}

/// Per stretch: place (2) and heading, of the scaled odometry's end in the true end's frame.
Eigen::VectorXd residuals_at(const std::vector<Pose>& scaled, const std::vector<Pose>& X_WR,
                             const std::vector<Stretch>& stretches) {
  Eigen::VectorXd out(3 * static_cast<Eigen::Index>(stretches.size()));
  Eigen::Index row = 0;
  for (const Stretch& s : stretches) {
    const Pose ours = scaled[s.first].inverse() * scaled[s.last];
    const Pose off = (X_WR[s.first].inverse() * X_WR[s.last]).inverse() * ours;
    out[row++] = off.translation().x();
    out[row++] = off.translation().y();
    out[row++] = kLever_m * geometry::heading_of(off);
  }
  return out;
}

void note_rms(const Eigen::VectorXd& residuals, double& metres, double& radians) {
  double squares_m = 0.0;
  double squares_rad = 0.0;
  const Eigen::Index n = residuals.size() / 3;
  for (Eigen::Index i = 0; i < n; ++i) {
    squares_m += residuals.segment<2>(3 * i).squaredNorm();
    squares_rad += residuals[3 * i + 2] * residuals[3 * i + 2] / (kLever_m * kLever_m);
  }
  metres = std::sqrt(squares_m / static_cast<double>(n));
  radians = std::sqrt(squares_rad / static_cast<double>(n));
}

/// Whether the fit says anything: what is left, what a robot's file takes, how sure it is.
Result<void> check_fit(const OdometryFit& fit, double stretch_m) {
  const double max_m = std::max(kGreatestRms_m, kGreatestRmsOfStretch * stretch_m);
  if (!(fit.rms_m <= max_m && fit.rms_rad <= kGreatestRms_rad)) {
    return fail(fmt::format(
        "scaled, the odometry's stretches end {:.1f} cm and {:.1f} degrees (RMS) off the true ones; expected at most "
        "{:.0f} cm and {:.0f} degrees: are both files of the same drive?",
        100.0 * fit.rms_m, fit.rms_rad * 180.0 / kPi, 100.0 * max_m, kGreatestRms_rad * 180.0 / kPi));
  }
  struct Scale {
    const char* name;
    double value;
    double sigma;
  };
  for (const auto& [name, value, sigma] :
       {Scale{"forward", fit.forward, fit.sigma_forward}, Scale{"turn", fit.turn, fit.sigma_turn}}) {
    constexpr Range<double> kTaken = stages::OdometryScales::kRange;
    if (!(value >= kTaken.minimum && value <= kTaken.maximum)) {
      return fail(
          fmt::format("the scale of {} is {:.4f}; expected {}..{}, as a robot's file takes it: are both files "
                      "in metres and of the same robot?",
                      name, value, kTaken.minimum, kTaken.maximum));
    }
    if (!(sigma <= kGreatestSigma)) {
      return fail(
          fmt::format("the scale of {} is {:.4f} +- {:.4f}; expected a standard error of at most {}: drive a "
                      "longer round with straight pieces and turns",
                      name, value, sigma, kGreatestSigma));
    }
  }
  return {};
}

}  // namespace

std::vector<Pose> scaled_odometry(const std::vector<Pose>& X_OR, double forward, double turn) {
  std::vector<Pose> out;
  out.reserve(X_OR.size());
  for (std::size_t i = 0; i < X_OR.size(); ++i) {
    if (i == 0) {
      out.push_back(X_OR[0]);
      continue;
    }
    const Pose step = X_OR[i - 1].inverse() * X_OR[i];
    const double turned = geometry::heading_of(step);
    // The way lies half-way between both headings; turned more, it turns along.
    const Eigen::Vector2d way =
        forward * (Eigen::Rotation2Dd(0.5 * (turn - 1.0) * turned) * step.translation().head<2>());
    out.push_back(out.back() * geometry::pose_on_floor(way.x(), way.y(), turn * turned));
  }
  return out;
}

Result<OdometryFit> calibrate_odometry(const std::vector<Pose>& X_OR, const std::vector<Pose>& X_WR, double stretch_m) {
  if (X_OR.size() != X_WR.size()) {
    return fail(
        fmt::format("{} poses of the odometry and {} true ones; expected as many of both", X_OR.size(), X_WR.size()));
  }
  double lean = 0.0;
  for (const Pose& X : X_WR) lean = std::max(lean, std::acos(std::clamp(X.linear()(2, 2), -1.0, 1.0)));
  if (lean > kGreatestLean_rad) {
    return fail(
        fmt::format("the true poses lean by up to {:.0f} degrees; expected the robot's, upright to {:.0f} degrees: "
                    "those of its camera need --mount",
                    lean * 180.0 / kPi, kGreatestLean_rad * 180.0 / kPi));
  }
  OdometryFit scales;
  for (std::size_t i = 1; i < X_OR.size(); ++i) {
    scales.way_m += (X_OR[i].translation() - X_OR[i - 1].translation()).norm();
    scales.turned_rad += std::abs(turn_between(X_OR[i - 1], X_OR[i]));
  }
  const std::vector<Stretch> stretches = stretches_of(X_OR, stretch_m);
  scales.stretches = static_cast<int>(stretches.size());
  if (scales.way_m < kLeastWay_m || scales.turned_rad < kLeastTurn_rad || scales.stretches < kFewestStretches) {
    return fail(fmt::format(
        "the round is {:.1f} m long with turns of {:.0f} degrees, {} stretches; expected at least {:.0f} m, {:.0f} "
        "degrees and {} stretches",
        scales.way_m, scales.turned_rad * 180.0 / kPi, scales.stretches, kLeastWay_m, kLeastTurn_rad * 180.0 / kPi,
        kFewestStretches));
  }
  note_rms(residuals_at(X_OR, X_WR, stretches), scales.rms_before_m, scales.rms_before_rad);
  const Fit fit = fit_least_squares(
      [&](const Eigen::VectorXd& v) { return residuals_at(scaled_odometry(X_OR, v[0], v[1]), X_WR, stretches); },
      Eigen::VectorXd::Ones(2));
  scales.forward = fit.parameters[0];
  scales.turn = fit.parameters[1];
  scales.sigma_forward = fit.sigma(0);
  scales.sigma_turn = fit.sigma(1);
  note_rms(fit.residuals, scales.rms_m, scales.rms_rad);
  if (auto good = check_fit(scales, stretch_m); !good) return tl::unexpected(good.error());
  return scales;
}

}  // namespace cgsr::calibration
