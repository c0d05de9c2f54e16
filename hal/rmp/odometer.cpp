#include "hal/rmp/odometer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::hal::rmp {
namespace {

constexpr double kSecondsPerServoFrame = 0.010;
// Past this the counters may have been reset and have grown again: start anew rather than believe a difference.
constexpr int kMostServoFrames = 100;

// Right also across the wrap, as long as the true difference is below 2^31.
double difference(std::uint32_t from, std::uint32_t to) {
  return static_cast<std::int32_t>(to - from);
}

}  // namespace

std::string_view to_string(Odometer::Outcome outcome) {
  switch (outcome) {
    case Odometer::Outcome::kBaseline:
      return "baseline";
    case Odometer::Outcome::kTravelled:
      return "travelled";
    case Odometer::Outcome::kJump:
      return "jump";
    case Odometer::Outcome::kNewBaseline:
      return "new baseline";
  }
  return "";
}

Odometer::Odometer(const RmpScales& scales, double most_mps, double most_radps)
    : m_per_count_(1.0 / scales.displacement_per_m),
      rad_per_count_(2.0 * std::numbers::pi / scales.yaw_per_rev),
      most_m_per_frame_(most_mps * kSecondsPerServoFrame),
      most_rad_per_frame_(most_radps * kSecondsPerServoFrame) {}

Odometer::Outcome Odometer::take(const Integrated& counts, std::uint16_t servo_frame) {
  const Reading now{counts, servo_frame};
  if (!last_) {
    last_ = now;
    return Outcome::kBaseline;
  }
  if (const auto travelled = step(*last_, now)) {
    travel(*travelled);
    last_ = now;
    suspect_.reset();
    return Outcome::kTravelled;
  }
  if (suspect_ && step(*suspect_, now)) {
    last_ = now;
    suspect_.reset();
    return Outcome::kNewBaseline;
  }
  suspect_ = now;
  return Outcome::kJump;
}

std::optional<Odometer::Step> Odometer::step(const Reading& from, const Reading& to) const {
  // The message with the counter may have been lost: two sets with one count are at least a frame apart.
  const int frames = std::max<int>(1, static_cast<std::uint16_t>(to.servo_frame - from.servo_frame));
  const Step step{.forward_m = difference(from.counts.fore_aft, to.counts.fore_aft) * m_per_count_,
                  .left_rad = difference(from.counts.yaw, to.counts.yaw) * rad_per_count_};
  // One frame more than counted: the values are taken at some moment of the frame.
  const bool possible = frames <= kMostServoFrames && std::abs(step.forward_m) <= (frames + 1) * most_m_per_frame_ &&
                        std::abs(step.left_rad) <= (frames + 1) * most_rad_per_frame_;
  return possible ? std::optional(step) : std::nullopt;
}

void Odometer::travel(const Step& step) {
  const double halfway = pose_.heading_rad + 0.5 * step.left_rad;
  pose_.x_m += step.forward_m * std::cos(halfway);
  pose_.y_m += step.forward_m * std::sin(halfway);
  pose_.heading_rad += step.left_rad;
}

}  // namespace cgsr::hal::rmp
