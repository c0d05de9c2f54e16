#include "pipeline/stages/odometry_track.h"

#include <cmath>

namespace cgsr::stages {
namespace {

double between(double from, double to, double share) {
  return from + (to - from) * share;
}

hal::Odometry blend(const hal::Odometry& earlier, const hal::Odometry& later, MonoTime stamp) {
  const double share = to_seconds(stamp - earlier.stamp) / to_seconds(later.stamp - earlier.stamp);
  hal::Odometry odometry = earlier;
  odometry.stamp = stamp;
  odometry.x_m = between(earlier.x_m, later.x_m, share);
  odometry.y_m = between(earlier.y_m, later.y_m, share);
  odometry.heading_rad = between(earlier.heading_rad, later.heading_rad, share);
  odometry.pitch_rad = between(earlier.pitch_rad, later.pitch_rad, share);
  odometry.velocity.forward_mps = between(earlier.velocity.forward_mps, later.velocity.forward_mps, share);
  odometry.velocity.left_radps = between(earlier.velocity.left_radps, later.velocity.left_radps, share);
  return odometry;
}

hal::Odometry led_on(const hal::Odometry& last, MonoTime stamp) {
  const double ahead_s = to_seconds(stamp - last.stamp);
  const double middle_rad = last.heading_rad + 0.5 * last.velocity.left_radps * ahead_s;
  hal::Odometry odometry = last;
  odometry.stamp = stamp;
  odometry.x_m += last.velocity.forward_mps * ahead_s * std::cos(middle_rad);
  odometry.y_m += last.velocity.forward_mps * ahead_s * std::sin(middle_rad);
  odometry.heading_rad += last.velocity.left_radps * ahead_s;
  return odometry;
}

}  // namespace

void OdometryTrack::add(const hal::Odometry& odometry) {
  if (count_ > 0 && odometry.stamp <= from_newest(0).stamp) return;
  reports_[next_] = count_ > 0 ? scaled(odometry) : odometry;
  as_reported_ = odometry;
  next_ = (next_ + 1) % kKept;
  count_ = count_ < kKept ? count_ + 1 : kKept;
}

// Goes on from the newest by the reported step times the scales: the first report's place is the same with any.
hal::Odometry OdometryTrack::scaled(const hal::Odometry& odometry) const {
  const hal::Odometry& before = from_newest(0);
  const double turned_rad = odometry.heading_rad - as_reported_.heading_rad;
  const double turned_scaled_rad = scales_.scale_turn * turned_rad;
  // The way lies half-way between both headings; turned more, it turns along.
  const double way_turn_rad = before.heading_rad - as_reported_.heading_rad + 0.5 * (turned_scaled_rad - turned_rad);
  const double dx_m = scales_.scale_forward * (odometry.x_m - as_reported_.x_m);
  const double dy_m = scales_.scale_forward * (odometry.y_m - as_reported_.y_m);
  hal::Odometry now = odometry;
  now.x_m = before.x_m + std::cos(way_turn_rad) * dx_m - std::sin(way_turn_rad) * dy_m;
  now.y_m = before.y_m + std::sin(way_turn_rad) * dx_m + std::cos(way_turn_rad) * dy_m;
  now.heading_rad = before.heading_rad + turned_scaled_rad;
  now.velocity.forward_mps *= scales_.scale_forward;
  now.velocity.left_radps *= scales_.scale_turn;
  return now;
}

std::optional<hal::Odometry> OdometryTrack::at(MonoTime stamp) const {
  if (count_ == 0) return std::nullopt;
  const hal::Odometry& newest = from_newest(0);
  if (stamp >= newest.stamp) {
    if (stamp - newest.stamp > kLongestAhead) return std::nullopt;
    return led_on(newest, stamp);
  }
  for (std::size_t i = 1; i < count_; ++i) {
    if (from_newest(i).stamp <= stamp) return blend(from_newest(i), from_newest(i - 1), stamp);
  }
  return std::nullopt;
}

geometry::Pose pose_of(const hal::Odometry& odometry, double axle_height_m) {
  const Eigen::Vector3d axle(0.0, 0.0, axle_height_m);
  geometry::Pose lean = geometry::Pose::Identity();
  lean.linear() = geometry::rotation_of({0.0, odometry.pitch_rad, 0.0});
  lean.translation() = axle - lean.linear() * axle;
  return geometry::pose_on_floor(odometry.x_m, odometry.y_m, odometry.heading_rad) * lean;
}

}  // namespace cgsr::stages
