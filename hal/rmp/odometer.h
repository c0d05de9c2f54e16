#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/rmp/messages.h"
#include "hal/rmp/scales.h"

namespace cgsr::hal::rmp {

/// Where the wheels say that the robot is: x, y and heading since the first set, out of integrated displacements that
/// start anywhere, wrap at 2^32, and now and then lie.
///
///   ds = counts / displacement_per_m,  dpsi = counts 2 pi / yaw_per_rev     differences modulo 2^32, signed
///   x += ds cos(psi + dpsi / 2),  y += ds sin(psi + dpsi / 2),  psi += dpsi
///
/// A difference that no base could have travelled in the time that the servo frame counter says has passed is a jump.
/// It waits for the next set: if that one continues from before the jump, the jump was a damaged value and nothing is
/// lost; if it continues from after it, the base started counting anew and so does the baseline, the pose staying where
/// it was.
class Odometer {
 public:
  struct Pose {
    double x_m = 0.0;
    double y_m = 0.0;
    double heading_rad = 0.0;  ///< not wrapped: whole turns add up.
  };

  enum class Outcome : std::uint8_t { kBaseline, kTravelled, kJump, kNewBaseline };

  /// \param most_mps, most_radps  no base is faster, > 0.
  Odometer(const RmpScales& scales, double most_mps, double most_radps);

  /// \param servo_frame  Motion's counter: of this set or the one before, but always the same of the two.
  Outcome take(const Integrated& counts, std::uint16_t servo_frame);

  [[nodiscard]] const Pose& pose() const { return pose_; }

 private:
  struct Reading {
    Integrated counts;
    std::uint16_t servo_frame = 0;
  };
  struct Step {
    double forward_m = 0.0;
    double left_rad = 0.0;
  };

  [[nodiscard]] std::optional<Step> step(const Reading& from, const Reading& to) const;
  void travel(const Step& step);

  double m_per_count_;
  double rad_per_count_;
  double most_m_per_frame_;
  double most_rad_per_frame_;
  std::optional<Reading> last_;
  std::optional<Reading> suspect_;
  Pose pose_;
};

std::string_view to_string(Odometer::Outcome outcome);

}  // namespace cgsr::hal::rmp
