#include "hal/sim/scene/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

Result<void> check(const std::vector<Waypoint>& waypoints, double start_s, double turn_radps) {
  if (waypoints.empty()) return fail("a path needs at least one waypoint");
  if (!std::isfinite(start_s)) return fail("a path starts at a time that is not finite");
  if (!(turn_radps > 0.0)) return fail(fmt::format("a turn rate of {} rad/s never turns", turn_radps));
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& w = waypoints[i];
    if (!w.p_W.allFinite()) return fail(fmt::format("waypoint {}: the position is not finite", i));
    if (!(w.speed_mps > 0.0)) return fail(fmt::format("waypoint {}: a speed of {} m/s never arrives", i, w.speed_mps));
    if (!(w.wait_s >= 0.0)) return fail(fmt::format("waypoint {}: waits {} s", i, w.wait_s));
    if (!std::isfinite(w.heading_rad)) return fail(fmt::format("waypoint {}: the heading is not finite", i));
  }
  return {};
}

}  // namespace

Result<Path> Path::make(std::vector<Waypoint> waypoints, double start_s, double turn_radps, bool loops) {
  if (auto good = check(waypoints, start_s, turn_radps); !good) return tl::unexpected(good.error());
  Path path;
  path.turn_radps_ = turn_radps;
  if (loops && waypoints.size() > 1) waypoints.push_back(waypoints.front());
  path.loops_ = loops && waypoints.size() > 1;

  double now = start_s;
  double walked = 0.0;
  double heading = waypoints.front().heading_rad;
  if (!waypoints.front().turns && waypoints.size() > 1) {
    const Eigen::Vector3d way = waypoints[1].p_W - waypoints[0].p_W;
    heading = arc_tangent(way.y(), way.x());
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& here = waypoints[i];
    if (i > 0) {
      const Eigen::Vector3d way = here.p_W - waypoints[i - 1].p_W;
      if (way.head<2>().norm() > 1e-9) heading = arc_tangent(way.y(), way.x());
      const double takes = way.norm() / here.speed_mps;
      if (takes > 0.0) path.legs_.push_back({now, now + takes, waypoints[i - 1].p_W, here.p_W, heading, walked});
      now += takes;
      walked += way.norm();
    }
    if (here.turns) heading = here.heading_rad;
    if (here.wait_s > 0.0 || waypoints.size() == 1) {
      path.legs_.push_back({now, now + here.wait_s, here.p_W, here.p_W, heading, walked});
      now += here.wait_s;
    }
  }
  if (!(now > start_s)) path.loops_ = false;
  if (path.legs_.empty()) {
    path.legs_.push_back({start_s, start_s, waypoints.front().p_W, waypoints.front().p_W, heading, 0.0});
  }
  return path;
}

Path Path::standing(const Eigen::Vector3d& p_W, double heading_rad) {
  Path path;
  path.legs_.push_back({0.0, 0.0, p_W, p_W, heading_rad, 0.0});
  return path;
}

double Path::duration_s() const {
  return legs_.empty() ? 0.0 : legs_.back().end_s - legs_.front().begin_s;
}

// A turn is spread evenly over the moment between two legs, as long as the turn rate needs but never more than half of either leg.
double Path::heading_near(std::size_t leg, double time_s, bool again) const {
  const Leg& here = legs_[leg];
  const auto blend = [&](const Leg& before, const Leg& after) {
    const double turn = wrap_angle(after.heading_rad - before.heading_rad);
    const double half = std::min({0.5 * std::abs(turn) / turn_radps_, 0.5 * (before.end_s - before.begin_s),
                                  0.5 * (after.end_s - after.begin_s)});
    if (half <= 0.0) return time_s < after.begin_s ? before.heading_rad : after.heading_rad;
    const double share = std::clamp((time_s - (after.begin_s - half)) / (2.0 * half), 0.0, 1.0);
    return wrap_angle(before.heading_rad + share * turn);
  };
  const auto shifted = [&](Leg other, double by_s) {
    other.begin_s += by_s;
    other.end_s += by_s;
    return other;
  };
  const bool in_first_half = time_s - here.begin_s < here.end_s - time_s;
  if (in_first_half) {
    if (leg > 0) return blend(legs_[leg - 1], here);
    if (again) return blend(shifted(legs_.back(), -duration_s()), here);
  } else {
    if (leg + 1 < legs_.size()) return blend(here, legs_[leg + 1]);
    if (loops_) return blend(here, shifted(legs_.front(), duration_s()));
  }
  return here.heading_rad;
}

PathPoint Path::at(double time_s) const {
  if (legs_.empty()) return {};
  const double begin = legs_.front().begin_s;
  double rounds = 0.0;
  double rounds_m = 0.0;
  if (loops_ && time_s > begin) {
    const double period = duration_s();
    rounds = std::floor((time_s - begin) / period);
    time_s -= rounds * period;
    const Leg& last = legs_.back();
    rounds_m = rounds * (last.walked_before_m + (last.to - last.from).norm());
  }
  if (time_s < begin) return {legs_.front().from, legs_.front().heading_rad, 0.0, 0.0};
  const auto after = std::find_if(legs_.begin(), legs_.end(), [&](const Leg& leg) { return leg.end_s > time_s; });
  if (after == legs_.end()) {
    const Leg& last = legs_.back();
    return {last.to, last.heading_rad, rounds_m + last.walked_before_m + (last.to - last.from).norm(), 0.0};
  }
  const double share = (time_s - after->begin_s) / (after->end_s - after->begin_s);
  const Eigen::Vector3d way = after->to - after->from;
  const double speed = way.norm() / (after->end_s - after->begin_s);
  return {after->from + share * way,
          heading_near(static_cast<std::size_t>(after - legs_.begin()), time_s, rounds > 0.0),
          rounds_m + after->walked_before_m + share * way.norm(), speed};
}

}  // namespace cgsr::sim
