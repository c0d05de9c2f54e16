#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "pipeline/geometry/pose.h"
#include "pipeline/illumination/lamp.h"

namespace cgsr::illumination {

/// A lamp that many images agree on: world frame, metres and square metres.
struct KnownLamp {
  Eigen::Vector3d p_WL = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  int seen = 0;    ///< images that showed it.
  int missed = 0;  ///< images in a row that should have and did not.
  bool steady = false;
};

/// What an image did to the lamps that are known.
struct LampChange {
  bool found = false;  ///< one became steady.
  bool gone = false;   ///< a steady one was given up: switched off, or moved.
};

/// Pulls the observations of many images together while the robot moves: each lamp is a Kalman filter over its place, over what was measured
/// wrongly on the board (tips and the board's turn), which stays the same from image to image, and over the error of the robot's pose, which fades with
/// the way (a Gauss-Markov process of first order). So standing still does not feign accuracy, and turning around tells lamp from board.
/// Ours: the dissertation (5.1) locates the lamp from one image. The filter (Kalman 1960) is an iterated one (Bell and Cathey 1993).
///
/// Threads: one. Nothing is allocated.
class LampFilter {
 public:
  static constexpr int kMostLamps = 4;

  LampFilter(const Board& board, const LampParameters& parameters);

  /// \param X_WR, pose_covariance  the robot's pose in this image and the covariance of geometry::moved(X_WR, step).
  LampChange update(const ProbeObservation& observation, const geometry::Pose& X_WR,
                    const geometry::Matrix6d& pose_covariance);

  [[nodiscard]] int count() const { return count_; }
  /// The best known first.
  [[nodiscard]] const KnownLamp& lamp(int i) const { return track_[static_cast<std::size_t>(i)].known; }
  void clear() {
    count_ = 0;
    before_.reset();
  }

 private:
  // Lamp 0..2, tips 3..5 and 6..8, the board's turn 9..11, the pose's error along x and y and in heading 12..14.
  static constexpr int kState = 15;
  using State = Eigen::Matrix<double, kState, 1>;
  using Covariance = Eigen::Matrix<double, kState, kState>;
  struct Track {
    State x = State::Zero();
    Covariance P = Covariance::Zero();
    KnownLamp known;
  };
  struct Prediction {
    Eigen::Vector2d p_BS = Eigen::Vector2d::Zero();
    Eigen::Matrix<double, 2, kState> J_state = Eigen::Matrix<double, 2, kState>::Zero();
    Eigen::Matrix<double, 2, 6> J_pose = Eigen::Matrix<double, 2, 6>::Zero();
    bool valid = false;
  };

  // The robot's pose in an image. What lasts of its error is in the state; the rest changes from image to image.
  struct Pose {
    geometry::Pose X_WR;
    Eigen::Matrix3d lasting;          // covariance of the error along x and y and in heading
    geometry::Matrix6d covariance;    // of the rest
    geometry::Matrix6d registration;  // of the camera against the board
  };
  using TrackShadows = std::array<const ProbeShadow*, kMostProbes>;
  struct Assignment {
    std::array<TrackShadows, kMostLamps> of_track{};
    std::array<std::array<bool, ShadowFinder::kMostShadows>, kMostProbes> taken{};
  };

  [[nodiscard]] Prediction predict(const State& x, std::size_t probe, const geometry::Pose& X_WR) const;
  [[nodiscard]] Pose pose_of(const ProbeObservation& observation, const geometry::Pose& X_WR,
                             const geometry::Matrix6d& pose_covariance) const;
  void fade_pose_errors(const Pose& pose);
  [[nodiscard]] Assignment assign(const ProbeObservation& observation, const Pose& pose) const;
  void correct_tracks(const ProbeObservation& observation, const Pose& pose, const Assignment& assigned,
                      LampChange& change);
  void start_tracks(const ProbeObservation& observation, const Pose& pose, const Assignment& assigned,
                    LampChange& change);
  [[nodiscard]] TrackShadows shadows_of(const LampEstimate& estimate, const ProbeObservation& observation) const;
  void drop_missed_tracks(LampChange& change);
  [[nodiscard]] double distance(const Track& track, std::size_t probe, const ProbeShadow& shadow,
                                const Pose& pose) const;
  void correct(Track& track, const TrackShadows& shadow, const Pose& pose, int iterations) const;
  [[nodiscard]] bool should_show(const Track& track, std::size_t probe, const geometry::Pose& X_WR,
                                 const geometry::Pose& X_BC) const;
  [[nodiscard]] Track started(const LampEstimate& estimate, const Pose& pose) const;

  Board board_;
  LampParameters parameters_;
  std::array<Track, kMostLamps> track_;
  int count_ = 0;
  std::optional<Pose> before_;  // in the last image that showed the board
};

}  // namespace cgsr::illumination
