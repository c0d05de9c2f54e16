#include "src/sinks/truth_sink.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

namespace cgsr::sinks {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// "at most 0.20 s", or that it did not happen.
std::string at_most(const std::optional<double>& value_s) {
  return value_s ? fmt::format("after at most {:.2f} s", *value_s) : "never in this run";
}

void add_object(const ObjectTruthStatistics& truth, Summary& summary) {
  summary.json["truth"] = {{"images", truth.images},
                           {"in_view_share", share(truth.in_view, truth.images)},
                           {"found_share", share(truth.found, truth.in_view)},
                           {"found_right_share", share(truth.found_right, truth.in_view)},
                           {"found_nothing", truth.found_nothing},
                           {"fastest_object_mps", truth.fastest_object_mps},
                           {"min_distance_m", truth.min_distance_m},
                           {"nearest_by_own_motion", or_null(truth.nearest_by_own_motion)},
                           {"losses", truth.losses},
                           {"longest_command_after_loss_s", or_null(truth.longest_command_after_loss_s)},
                           {"longest_roll_after_loss_s", or_null(truth.longest_roll_after_loss_s)},
                           {"nearings", truth.nearings},
                           {"longest_command_when_nearer_s", or_null(truth.longest_command_when_nearer_s)}};
  summary.text += fmt::format(
      "truth, from the first detection on: the object existed in {} images, in view in {:.1f} %; of these the robot "
      "found {:.1f} %, {:.1f} % with the right box; {} times it found what was not in view\n",
      truth.images, 100.0 * share(truth.in_view, truth.images), 100.0 * share(truth.found, truth.in_view),
      100.0 * share(truth.found_right, truth.in_view), truth.found_nothing);
  summary.text += fmt::format(
      "smallest distance by its own motion, as a share of the set distance: {}; smallest distance {:.2f} m\n",
      truth.nearest_by_own_motion ? fmt::format("{:.2f}", *truth.nearest_by_own_motion) : "it never drove forward",
      truth.min_distance_m);
  summary.text += fmt::format("object lost {} times: command zero {}, standing {}\n", truth.losses,
                              at_most(truth.longest_command_after_loss_s), at_most(truth.longest_roll_after_loss_s));
  summary.text += fmt::format("object came nearer {} times: command zero {}\n\n", truth.nearings,
                              at_most(truth.longest_command_when_nearer_s));
}

void add_pose(const PoseTruthStatistics& pose, Summary& summary) {
  summary.json["pose"] = {{"images", pose.images},
                          {"corrected_share", share(pose.corrected, pose.images)},
                          {"lost", pose.lost},
                          {"searching", pose.searching},
                          {"mean_cm", 100.0 * pose.mean_m},
                          {"worst_cm", 100.0 * pose.worst_m},
                          {"worst_at_s", pose.worst_s},
                          {"mean_deg", kDegrees * pose.mean_rad},
                          {"worst_deg", kDegrees * pose.worst_rad},
                          {"accurate_share", share(pose.accurate, pose.images)},
                          {"first_at_s", pose.first_s},
                          {"longest_lost_s", pose.longest_lost_s},
                          {"longest_wrong_s", pose.longest_wrong_s},
                          {"way_m", pose.way_m},
                          {"odometry_ends_off_cm", 100.0 * pose.odometry_ends_off_m},
                          {"odometry_worst_cm", 100.0 * pose.odometry_worst_m}};
  summary.text += fmt::format(
      "pose by truth, from the first correction on: {} images, corrected in {:.1f} %, lost {} times, the whole map "
      "searched in {} images more; error {:.1f} cm and {:.2f} deg in the mean, {:.1f} cm (at {:.1f} s) and {:.2f} deg "
      "at worst\n"
      "under {:.0f} cm and {:.1f} deg in {:.1f} %; lost for at most {:.1f} s on end, farther off without saying so for "
      "at most {:.1f} s\n"
      "{:.1f} m driven; odometry alone would have been {:.0f} cm off at worst, {:.0f} cm at the end\n\n",
      pose.images, 100.0 * share(pose.corrected, pose.images), pose.lost, pose.searching, 100.0 * pose.mean_m,
      kDegrees * pose.mean_rad, 100.0 * pose.worst_m, pose.worst_s, kDegrees * pose.worst_rad, 100.0 * kAccurate_m,
      kDegrees * kAccurate_rad, 100.0 * share(pose.accurate, pose.images), pose.longest_lost_s, pose.longest_wrong_s,
      pose.way_m, 100.0 * pose.odometry_worst_m, 100.0 * pose.odometry_ends_off_m);
}

}  // namespace

Result<void> TruthSink::on_image(const ImageReport& report) {
  ground_truth_ = {};
  truth_ = simulation_.truth(report.record.stamp);
  if (truth_) {
    if (truth_->in_view) ground_truth_.box = truth_->box;
    object_.add(*truth_, report.frame.objects.value.first().object, report.motion);
    if (const auto off = pose_.add(*truth_, report.frame.pose.value, report.motion.odometry)) {
      ground_truth_.camera_off_m = off->position_m;
      ground_truth_.camera_off_deg = kDegrees * off->direction_rad;
    }
    judge_lamp(report.frame.lamp.value);
  }
  if (observer_ && report.picture != nullptr) observer_(report.picture->image.view(), report, truth_);
  return {};
}

void TruthSink::judge_lamp(const stages::LampReport& lamp) {
  if (!lamp.has_board || !lamp.known || !truth_->lamp_burns) return;
  const Eigen::Vector3d p_WL(truth_->lamp_m[0], truth_->lamp_m[1], truth_->lamp_m[2]);
  lamp_.last_m = (lamp.lamp.p_WL - p_WL).norm();
  lamp_.worst_m = std::max(lamp_.worst_m, lamp_.last_m);
  lamp_.mean_m += (lamp_.last_m - lamp_.mean_m) / static_cast<double>(++lamp_.compared);
}

void TruthSink::summarize(Summary& summary) {
  if (set_distance_m_ > 0.0) add_object(object_.statistics(), summary);
  if (pose_.statistics().images > 0) add_pose(pose_.statistics(), summary);
  if (lamp_.compared == 0) return;
  summary.json["light"]["mean_cm"] = 100.0 * lamp_.mean_m;
  summary.json["light"]["worst_cm"] = 100.0 * lamp_.worst_m;
  summary.json["light"]["last_cm"] = 100.0 * lamp_.last_m;
  summary.text +=
      fmt::format("lamp by truth: error {:.1f} cm at the end, {:.1f} cm in the mean, {:.1f} cm at worst\n\n",
                  100.0 * lamp_.last_m, 100.0 * lamp_.mean_m, 100.0 * lamp_.worst_m);
}

}  // namespace cgsr::sinks
