#include "pipeline/illumination/lamp_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace cgsr::illumination {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kGate = 16.0;  // of one shadow, 2 degrees of freedom: 3 in 10,000 are further away
constexpr double kRegistrationNoise =
    0.25;  // of the registration's variance, what changes from image to image; the rest is calibration
constexpr double kStartSigma_m = 6.0;                          // along the floor, before the first shadow
constexpr Eigen::Index kTips = 3, kTurn = 9, kPoseError = 12;  // in the state
constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kMaxOwnShadow_m = 0.05;  // of a shadow from where its lamp's first estimate puts it

// Of the steps that geometry::moved() takes, those along the floor: the rest of a robot's pose is known.
constexpr std::array<Eigen::Index, 3> kAlongFloor{0, 1, 5};

/// The robot where the state's error of the pose has it.
geometry::Pose corrected(const geometry::Pose& X_WR, const Vector3d& error) {
  geometry::Vector6d step = geometry::Vector6d::Zero();
  step(kAlongFloor) = error;
  return geometry::moved(X_WR, step);
}

/// The share that is left of an error that fades to 1/e over `fades`; 0: nothing is.
double left_of(double passed, double fades) {
  return fades > 0.0 ? std::exp(-passed / fades) : 0.0;
}

Matrix3d cross(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

LampFilter::LampFilter(const Board& board, const LampParameters& parameters) : board_(board), parameters_(parameters) {}

LampFilter::Prediction LampFilter::predict(const State& x, std::size_t probe, const geometry::Pose& X_WR_told) const {
  Prediction prediction;
  const geometry::Pose X_WR = corrected(X_WR_told, x.segment<3>(kPoseError));
  const Vector3d p_RL = X_WR.inverse() * Vector3d(x.head<3>());
  const Vector3d before_turn = board_.X_RB.inverse() * p_RL;
  const Vector3d turn = x.segment<3>(kTurn);
  const Vector3d p_BL = before_turn + before_turn.cross(turn);
  const Vector3d tip = board_.probe[probe].p_BA + x.segment<3>(kTips + 3 * static_cast<Eigen::Index>(probe));
  if (p_BL.z() < tip.z() + 0.05) return prediction;
  const auto model = shadow_of(p_BL, tip);
  prediction.p_BS = model.p_BS;
  const Matrix3d R_BW = (X_WR.linear() * board_.X_RB.linear()).transpose();
  const Eigen::Matrix<double, 2, 3> J_world = model.J_lamp * R_BW;
  prediction.J_state.leftCols<3>() = J_world;
  prediction.J_state.middleCols<3>(kTips + 3 * static_cast<Eigen::Index>(probe)) = model.J_tip;
  prediction.J_state.middleCols<3>(kTurn) = model.J_lamp * cross(before_turn);
  // The robot moved by a step is the lamp moved the other way.
  prediction.J_pose.leftCols<3>() = -J_world;
  prediction.J_pose.rightCols<3>() = J_world * cross(Vector3d(x.head<3>()) - X_WR.translation());
  prediction.J_state.middleCols<3>(kPoseError) = prediction.J_pose(Eigen::all, kAlongFloor);
  prediction.valid = true;
  return prediction;
}

double LampFilter::distance(const Track& track, std::size_t probe, const ProbeShadow& shadow, const Pose& pose) const {
  const auto prediction = predict(track.x, probe, pose.X_WR);
  if (!prediction.valid) return std::numeric_limits<double>::infinity();
  const Vector2d residual = shadow.p_BS - prediction.p_BS;
  const Matrix2d S = prediction.J_state * track.P * prediction.J_state.transpose() +
                     prediction.J_pose * pose.covariance * prediction.J_pose.transpose() + shadow.covariance +
                     shadow.J_pose * pose.registration * shadow.J_pose.transpose();
  return residual.dot(S.inverse() * residual);
}

void LampFilter::correct(Track& track, const TrackShadows& shadow, const Pose& pose, int iterations) const {
  using Joint = Eigen::Matrix<double, 4, 1>;
  using Wide = Eigen::Matrix<double, 4, kState>;
  State x = track.x;
  Wide H = Wide::Zero();
  Eigen::Matrix<double, kState, 4> gain = Eigen::Matrix<double, kState, 4>::Zero();
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Joint residual = Joint::Zero();
    Eigen::Matrix<double, 4, 6> J_pose = Eigen::Matrix<double, 4, 6>::Zero();
    Eigen::Matrix<double, 4, 6> J_camera = Eigen::Matrix<double, 4, 6>::Zero();
    Eigen::Matrix4d V = Eigen::Matrix4d::Identity();
    H.setZero();
    for (std::size_t i = 0; i < kMostProbes; ++i) {
      if (shadow[i] == nullptr) continue;
      const auto prediction = predict(x, i, pose.X_WR);
      if (!prediction.valid) return;
      const auto row = static_cast<Eigen::Index>(2 * i);
      residual.segment<2>(row) = shadow[i]->p_BS - prediction.p_BS;
      H.middleRows<2>(row) = prediction.J_state;
      J_pose.middleRows<2>(row) = prediction.J_pose;
      J_camera.middleRows<2>(row) = shadow[i]->J_pose;
      V.block<2, 2>(row, row) = shadow[i]->covariance;
    }
    V += J_pose * pose.covariance * J_pose.transpose() + J_camera * pose.registration * J_camera.transpose();
    const Eigen::Matrix4d S = H * track.P * H.transpose() + V;
    const Eigen::LLT<Eigen::Matrix4d> solver(S);
    if (solver.info() != Eigen::Success) return;
    gain = solver.solve(H * track.P).transpose();
    // The iterated filter: linearised where it has come to, corrected from where it was.
    const Joint innovation = residual - H * (track.x - x);
    x = track.x + gain * innovation;
  }
  track.x = x;
  const Covariance P = track.P - gain * H * track.P;
  track.P = 0.5 * (P + P.transpose());
}

LampFilter::Track LampFilter::started(const LampEstimate& estimate, const Pose& pose) const {
  Track track;
  track.x.head<3>() = pose.X_WR * estimate.p_RL;
  track.x[2] = parameters_.height_m;
  track.P.diagonal().head<2>().setConstant(kStartSigma_m * kStartSigma_m);
  track.P(2, 2) = parameters_.height_sigma_m * parameters_.height_sigma_m;
  // Tip and foot both were measured, and what is seen hangs on their difference.
  track.P.diagonal().segment<6>(kTips).setConstant(2.0 * board_.place_sigma_m * board_.place_sigma_m);
  track.P.diagonal().segment<3>(kTurn).setConstant(board_.turn_sigma_rad * board_.turn_sigma_rad);
  track.P.block<3, 3>(kPoseError, kPoseError) = pose.lasting;
  return track;
}

bool LampFilter::should_show(const Track& track, std::size_t probe, const geometry::Pose& X_WR,
                             const geometry::Pose& X_BC) const {
  const auto prediction = predict(track.x, probe, X_WR);
  if (!prediction.valid) return false;
  const Vector2d& p = prediction.p_BS;
  const Probe& of = board_.probe[probe];
  if ((p - of.foot_B).norm() < 1.6 * of.radius_m) return false;
  if (std::abs(p.x()) > board_.depth_m / 2 - 0.01 || std::abs(p.y()) > board_.width_m / 2 - 0.01) return false;
  const BoardView view(board_.camera, X_BC);
  const auto pixel = view.pixel({p.x(), p.y(), 0.0});
  if (!pixel.in_front || pixel.at.x() < 10.0 || pixel.at.y() < 10.0 || pixel.at.x() > board_.camera.width_px - 11.0 ||
      pixel.at.y() > board_.camera.height_px - 11.0) {
    return false;
  }
  for (int i = 0; i < board_.probes; ++i) {
    const Probe& cone = board_.probe[static_cast<std::size_t>(i)];
    const Outline outline = outline_of(cone.foot_B, cone.radius_m, cast(view.p_BC(), cone.p_BA));
    if (within(outline, cone.foot_B, cone.radius_m, p, 0.01)) return false;
  }
  return true;
}

LampFilter::Pose LampFilter::pose_of(const ProbeObservation& observation, const geometry::Pose& X_WR,
                                     const geometry::Matrix6d& pose_covariance) const {
  Pose pose{.X_WR = X_WR,
            .lasting = pose_covariance(kAlongFloor, kAlongFloor),
            .covariance = pose_covariance,
            .registration = kRegistrationNoise * observation.registration.covariance};
  const double place = parameters_.min_pose_sigma_m * parameters_.min_pose_sigma_m;
  const double turn = parameters_.min_pose_sigma_deg * kRadPerDeg;
  pose.lasting(0, 0) = std::max(pose.lasting(0, 0), place);
  pose.lasting(1, 1) = std::max(pose.lasting(1, 1), place);
  pose.lasting(2, 2) = std::max(pose.lasting(2, 2), turn * turn);
  for (const Eigen::Index i : kAlongFloor) {
    pose.covariance.row(i).setZero();
    pose.covariance.col(i).setZero();
  }
  return pose;
}

// As far as the robot has come since the last image, and what the pose became less sure of meanwhile.
void LampFilter::fade_pose_errors(const Pose& pose) {
  if (!before_) return;
  const geometry::Vector6d moved = geometry::step_between(before_->X_WR, pose.X_WR);
  const double left = left_of(moved.head<3>().norm(), parameters_.pose_error_way_m) *
                      left_of(moved.tail<3>().norm(), parameters_.pose_error_turn_deg * kRadPerDeg);
  const Vector3d grown = (pose.lasting - before_->lasting).diagonal().cwiseMax(0.0);
  for (int t = 0; t < count_; ++t) {
    Track& track = track_[static_cast<std::size_t>(t)];
    track.x.segment<3>(kPoseError) *= left;
    track.P.middleRows<3>(kPoseError) *= left;
    track.P.middleCols<3>(kPoseError) *= left;
    track.P.block<3, 3>(kPoseError, kPoseError) += (1.0 - left * left) * pose.lasting;
    track.P.diagonal().segment<3>(kPoseError) += left * left * grown;
  }
}

// Whose shadow is it? The nearest pair of track and shadow first.
LampFilter::Assignment LampFilter::assign(const ProbeObservation& observation, const Pose& pose) const {
  Assignment assigned;
  for (std::size_t probe = 0; probe < kMostProbes; ++probe) {
    const auto& found = observation.probe[probe];
    for (int round = 0; round < found.count; ++round) {
      double nearest = kGate;
      int track_of = -1;
      int shadow_of_track = -1;
      for (int t = 0; t < count_; ++t) {
        if (assigned.of_track[static_cast<std::size_t>(t)][probe] != nullptr) continue;
        for (int k = 0; k < found.count; ++k) {
          if (assigned.taken[probe][static_cast<std::size_t>(k)]) continue;
          const double d =
              distance(track_[static_cast<std::size_t>(t)], probe, found.shadow[static_cast<std::size_t>(k)], pose);
          if (d < nearest) nearest = d, track_of = t, shadow_of_track = k;
        }
      }
      if (track_of < 0) break;
      assigned.of_track[static_cast<std::size_t>(track_of)][probe] =
          &found.shadow[static_cast<std::size_t>(shadow_of_track)];
      assigned.taken[probe][static_cast<std::size_t>(shadow_of_track)] = true;
    }
  }
  return assigned;
}

// A lamp is corrected by its shadows; one whose shadow should have been seen and was not is missed.
void LampFilter::correct_tracks(const ProbeObservation& observation, const Pose& pose, const Assignment& assigned,
                                LampChange& change) {
  for (int t = 0; t < count_; ++t) {
    Track& track = track_[static_cast<std::size_t>(t)];
    const auto& shadow = assigned.of_track[static_cast<std::size_t>(t)];
    if (shadow[0] != nullptr || shadow[1] != nullptr) {
      correct(track, shadow, pose, 2);
      ++track.known.seen;
      track.known.missed = 0;
      if (!track.known.steady && track.known.seen >= parameters_.min_steady_images) {
        track.known.steady = true;
        change.found = true;
      }
      continue;
    }
    bool expected = false;
    for (int i = 0; i < board_.probes; ++i) {
      const bool is_blinded =
          (observation.saturated & (1 << i)) != 0 && observation.probe[static_cast<std::size_t>(i)].count == 0;
      if ((observation.missing & (1 << i)) != 0 || is_blinded) continue;
      expected = expected || should_show(track, static_cast<std::size_t>(i), pose.X_WR, observation.registration.X_BC);
    }
    if (expected) ++track.known.missed;
  }
}

// Shadows of no known lamp begin a lamp of their own.
void LampFilter::start_tracks(const ProbeObservation& observation, const Pose& pose, const Assignment& assigned,
                              LampChange& change) {
  ProbeObservation rest = observation;
  int left_over = 0;
  for (std::size_t probe = 0; probe < kMostProbes; ++probe) {
    rest.probe[probe].count = 0;
    for (int k = 0; k < observation.probe[probe].count; ++k) {
      if (assigned.taken[probe][static_cast<std::size_t>(k)]) continue;
      rest.probe[probe].shadow[static_cast<std::size_t>(rest.probe[probe].count++)] =
          observation.probe[probe].shadow[static_cast<std::size_t>(k)];
      ++left_over;
    }
  }
  if (left_over == 0) return;
  const auto lamps = locate_lamps(board_, parameters_, rest);
  for (int i = 0; i < lamps.count && count_ < kMostLamps; ++i) {
    const LampEstimate& estimate = lamps.lamp[static_cast<std::size_t>(i)];
    if (estimate.status != LampStatus::kFound) continue;
    Track track = started(estimate, pose);
    correct(track, shadows_of(estimate, rest), pose, 4);
    track.known.seen = 1;
    track.known.steady = parameters_.min_steady_images <= 1;
    change.found = change.found || track.known.steady;
    track_[static_cast<std::size_t>(count_++)] = track;
  }
}

// An estimate's own shadows: those nearest to where it puts them.
LampFilter::TrackShadows LampFilter::shadows_of(const LampEstimate& estimate,
                                                const ProbeObservation& observation) const {
  TrackShadows shadow{};
  for (std::size_t probe = 0; probe < kMostProbes; ++probe) {
    if ((estimate.probes & (1 << probe)) == 0) continue;
    const auto model = shadow_of(board_.X_RB.inverse() * estimate.p_RL, board_.probe[probe].p_BA);
    double nearest = kMaxOwnShadow_m;
    for (int k = 0; k < observation.probe[probe].count; ++k) {
      const ProbeShadow& candidate = observation.probe[probe].shadow[static_cast<std::size_t>(k)];
      const double apart = (candidate.p_BS - model.p_BS).norm();
      if (apart < nearest) nearest = apart, shadow[probe] = &candidate;
    }
  }
  return shadow;
}

void LampFilter::drop_missed_tracks(LampChange& change) {
  for (int t = 0; t < count_;) {
    Track& track = track_[static_cast<std::size_t>(t)];
    track.known.p_WL = track.x.head<3>();
    track.known.covariance = track.P.topLeftCorner<3, 3>();
    const bool doubted = !track.known.steady && track.known.missed >= 2;
    if (track.known.missed < parameters_.max_missing_images && !doubted) {
      ++t;
      continue;
    }
    change.gone = change.gone || track.known.steady;
    track_[static_cast<std::size_t>(t)] = track_[static_cast<std::size_t>(--count_)];
  }
}

LampChange LampFilter::update(const ProbeObservation& observation, const geometry::Pose& X_WR,
                              const geometry::Matrix6d& pose_covariance) {
  LampChange change;
  if (observation.status != ObservationStatus::kSeen && observation.status != ObservationStatus::kNoShadow)
    return change;
  const Pose pose = pose_of(observation, X_WR, pose_covariance);
  fade_pose_errors(pose);
  before_ = pose;
  const Assignment assigned = assign(observation, pose);
  correct_tracks(observation, pose, assigned, change);
  start_tracks(observation, pose, assigned, change);
  drop_missed_tracks(change);
  const auto before = [](const Track& a, const Track& b) {
    if (a.known.steady != b.known.steady) return a.known.steady;
    return a.known.seen > b.known.seen;
  };
  std::sort(track_.begin(), track_.begin() + count_, before);
  return change;
}

}  // namespace cgsr::illumination
