#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hal/drive.h"
#include "pipeline/geometry/pose.h"
#include "platform/parameters.h"

namespace cgsr::stages {

/// By what the base's way and turn are to be multiplied: what `cgsr calibrate odometry` finds.
struct OdometryScales {
  static constexpr Range<double> kRange{0.5, 2.0};

  double scale_forward = 1.0;
  double scale_turn = 1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number(
        "scale_forward", self.scale_forward, kRange, "",
        "The factor from the distance that the base reports to the robot's, as estimated by cgsr calibrate odometry.");
    visit.number(
        "scale_turn", self.scale_turn, kRange, "",
        "The factor from the turn that the base reports to the robot's, as estimated by cgsr calibrate odometry.");
  }
};

/// The base's odometry of the last second, scaled, so that an image can be told where the robot was when it was exposed.
/// Ours: the dissertation (4.1) assumes a pose estimate and does not say how it follows the motion.
///
/// Threads: one. Allocates nothing.
class OdometryTrack {
 public:
  OdometryTrack() = default;
  explicit OdometryTrack(const OdometryScales& scales) : scales_(scales) {}

  /// \param odometry  stamped later than all before; other messages are ignored.
  void add(const hal::Odometry& odometry);

  /// \return the odometry at a moment: between two reports on the straight way between them; after the last one, and at most kLongestAhead
  ///         later, as its velocity leads on. Nothing when the moment is before the oldest report or too late.
  [[nodiscard]] std::optional<hal::Odometry> at(MonoTime stamp) const;

  static constexpr Duration kLongestAhead = seconds(0.1);

 private:
  static constexpr std::size_t kKept = 128;

  [[nodiscard]] const hal::Odometry& from_newest(std::size_t i) const {
    return reports_[(next_ + kKept - 1 - i) % kKept];
  }

  [[nodiscard]] hal::Odometry scaled(const hal::Odometry& odometry) const;

  OdometryScales scales_;
  hal::Odometry as_reported_;  ///< the newest
  std::array<hal::Odometry, kKept> reports_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

/// \return X_OR: on the floor, and leaning about the axle as the base's pitch says.
/// \param axle_height_m  above the floor.
geometry::Pose pose_of(const hal::Odometry& odometry, double axle_height_m);

}  // namespace cgsr::stages
