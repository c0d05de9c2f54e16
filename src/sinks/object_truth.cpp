#include "src/sinks/object_truth.h"

#include <algorithm>

namespace cgsr::sinks {
namespace {

constexpr double kRolls_mps = 0.05;
constexpr double kRightOverlap = 0.4;

void keep_smallest(std::optional<double>& smallest, double value) {
  smallest = std::min(smallest.value_or(value), value);
}

}  // namespace

void ObjectTruth::Wait::end_at(MonoTime now, std::optional<double>& longest) {
  if (!since) return;
  longest = std::max(longest.value_or(0.0), to_seconds(now - *since));
  since.reset();
}

void ObjectTruth::add(const hal::ImageTruth& truth, const color::TrackedObject& object, const MotionStatus& motion) {
  seen_ = seen_ || object.found;
  if (!seen_) return;
  const bool commanded_forward = motion.commanded.forward_mps > 0.0;
  count(truth, object);
  watch_losses(truth, commanded_forward);
  watch_nearings(truth, commanded_forward);
}

void ObjectTruth::count(const hal::ImageTruth& truth, const color::TrackedObject& object) {
  statistics_.found_nothing += object.found && !truth.in_view ? 1 : 0;
  if (!truth.there) return;
  ++statistics_.images;
  statistics_.fastest_object_mps = std::max(statistics_.fastest_object_mps, truth.object_mps);
  const double min_m = statistics_.min_distance_m;
  statistics_.min_distance_m = min_m == 0.0 ? truth.distance_m : std::min(min_m, truth.distance_m);
  if (truth.robot_forward_mps > kRolls_mps && truth.nearing_mps <= 0.0) {
    keep_smallest(statistics_.nearest_by_own_motion, truth.distance_m / set_distance_m_);
  }
  if (!truth.in_view) return;
  ++statistics_.in_view;
  if (!object.found) return;
  ++statistics_.found;
  statistics_.found_right += intersection_over_union(object.box, truth.box) >= kRightOverlap ? 1 : 0;
}

void ObjectTruth::watch_losses(const hal::ImageTruth& truth, bool commanded_forward) {
  const bool rolls = truth.robot_forward_mps > kRolls_mps;
  if (was_in_view_ && !truth.in_view && (rolls || commanded_forward)) {
    ++statistics_.losses;
    command_after_loss_.since = truth.stamp;
    roll_after_loss_.since = truth.stamp;
  }
  was_in_view_ = truth.in_view;
  if (!commanded_forward || truth.in_view) {
    command_after_loss_.end_at(truth.stamp, statistics_.longest_command_after_loss_s);
  }
  if (!rolls || truth.in_view) roll_after_loss_.end_at(truth.stamp, statistics_.longest_roll_after_loss_s);
}

void ObjectTruth::watch_nearings(const hal::ImageTruth& truth, bool commanded_forward) {
  const bool nearer = truth.there && truth.distance_m < set_distance_m_ && truth.nearing_mps > 0.0;
  if (nearer && !was_nearer_) {
    ++statistics_.nearings;
    command_when_nearer_.since = truth.stamp;
  }
  was_nearer_ = nearer;
  if (!commanded_forward || !nearer) {
    command_when_nearer_.end_at(truth.stamp, statistics_.longest_command_when_nearer_s);
  }
}

}  // namespace cgsr::sinks
