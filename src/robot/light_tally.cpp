#include "src/robot/light_tally.h"

#include <algorithm>

namespace cgsr::robot {

void LightTally::add(const Decision& decision, const std::optional<hal::ImageTruth>& truth) {
  const LampSight& sight = decision.lamp;
  if (!sight.has_board) return;
  if (decision.lamp_age == Duration::zero()) {
    ++figures_.looks;
    if (const auto reason = reason_of(sight); !reason.empty()) ++figures_.unanswered[reason];
  }
  figures_.masked += decision.shade.status == ShadeStatus::kMasked ? 1 : 0;
  if (!sight.known) return;
  ++figures_.known;
  figures_.last = sight.lamp;
  if (!truth || !truth->lamp_burns) return;
  const Eigen::Vector3d p_WL(truth->lamp_m[0], truth->lamp_m[1], truth->lamp_m[2]);
  figures_.last_m = (sight.lamp.p_WL - p_WL).norm();
  figures_.worst_m = std::max(figures_.worst_m, figures_.last_m);
  figures_.mean_m += (figures_.last_m - figures_.mean_m) / static_cast<double>(++figures_.compared);
}

}  // namespace cgsr::robot
