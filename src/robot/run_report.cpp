#include "src/robot/run_report.h"

#include <cmath>
#include <numbers>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "platform/config/canonical.h"

namespace cgsr::robot {
namespace {

using Json = nlohmann::ordered_json;

template <class Visitor>
void visit_rings(const Links& links, Visitor visit) {
  visit("images", links.images.statistics());
  visit("goals", links.goals.statistics());
  visit("odometry", links.odometry.statistics());
  visit("arm_requests", links.arm_requests.statistics());
  visit("switch_requests", links.switch_requests.statistics());
  visit("switch_answers", links.switch_answers.statistics());
  visit("switchings", links.switchings.statistics());
  visit("reports", links.reports.statistics());
  visit("pictures", links.pictures.statistics());
  visit("motions", links.motions.statistics());
}

Json stages_json(const runtime::StageTable& table) {
  Json stages = Json::object();
  for (const auto& stage : table.stages()) {
    stages[stage.name] = {{"runs", stage.runs},         {"skips", stage.skips},        {"overruns", stage.overruns},
                          {"faults", stage.faults},     {"mean_us", stage.mean_us},    {"p99_us", stage.p99_us},
                          {"worst_us", stage.worst_us}, {"budget_us", stage.budget_us}};
  }
  return stages;
}

Json motion_json(const RunTally& tally) {
  const auto& last = tally.last_motion;
  return {{"beats", tally.beats},
          {"beats_in_motion", tally.beats_in_motion},
          {"fastest_mps", tally.fastest_mps},
          {"fastest_radps", tally.fastest_radps},
          {"last_command", {last.commanded.forward_mps, last.commanded.left_radps}},
          {"odometry", {last.odometry.x_m, last.odometry.y_m, last.odometry.heading_rad}},
          {"stop_cause", text(last.cause)},
          {"latched", text(last.latched)}};
}

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

Json truth_json(const TruthFigures& truth) {
  return {{"images", truth.images},
          {"in_view_share", share(truth.in_view, truth.images)},
          {"found_share", share(truth.found, truth.in_view)},
          {"found_right_share", share(truth.found_right, truth.in_view)},
          {"found_nothing", truth.found_nothing},
          {"fastest_object_mps", truth.fastest_object_mps},
          {"smallest_distance_m", truth.smallest_distance_m},
          {"nearest_by_own_motion", or_null(truth.nearest_by_own_motion)},
          {"losses", truth.losses},
          {"longest_command_after_loss_s", or_null(truth.longest_command_after_loss_s)},
          {"longest_roll_after_loss_s", or_null(truth.longest_roll_after_loss_s)},
          {"nearings", truth.nearings},
          {"longest_command_when_nearer_s", or_null(truth.longest_command_when_nearer_s)}};
}

constexpr double kDegrees = 180.0 / std::numbers::pi;

Json pose_json(const PoseFigures& pose) {
  return {{"images", pose.images},
          {"corrected_share", share(pose.corrected, pose.images)},
          {"lost", pose.lost},
          {"mean_cm", 100.0 * pose.mean_m},
          {"worst_cm", 100.0 * pose.worst_m},
          {"worst_at_s", pose.worst_s},
          {"mean_deg", kDegrees * pose.mean_rad},
          {"worst_deg", kDegrees * pose.worst_rad},
          {"way_m", pose.way_m},
          {"odometry_ends_off_cm", 100.0 * pose.odometry_ends_off_m},
          {"odometry_worst_cm", 100.0 * pose.odometry_worst_m}};
}

std::string pose_text(const PoseFigures& pose) {
  return fmt::format(
      "pose by truth, from the first correction on: {} images, corrected in {:.1f} %, lost {} times; off by {:.1f} cm "
      "and {:.2f} deg in the mean, {:.1f} cm (at {:.1f} s) and {:.2f} deg at worst\n"
      "{:.1f} m driven; odometry alone would have been {:.0f} cm off at worst, {:.0f} cm at the end\n\n",
      pose.images, 100.0 * share(pose.corrected, pose.images), pose.lost, 100.0 * pose.mean_m, kDegrees * pose.mean_rad,
      100.0 * pose.worst_m, pose.worst_s, kDegrees * pose.worst_rad, pose.way_m, 100.0 * pose.odometry_worst_m,
      100.0 * pose.odometry_ends_off_m);
}

Json seek_json(const std::vector<SeekStep>& steps) {
  Json json = Json::array();
  for (const SeekStep& step : steps) {
    json.push_back({{"state", behavior::text(step.state)},
                    {"reason", behavior::text(step.reason)},
                    {"image", step.image},
                    {"at_s", step.at_s}});
  }
  return json;
}

std::string seek_text(const std::vector<SeekStep>& steps) {
  std::string text = "Algorithm 5.2, image by image:\n";
  for (const SeekStep& step : steps) {
    text += fmt::format("{:>8} {:>7.1f} s  {:<32} {}\n", step.image, step.at_s, behavior::text(step.state),
                        behavior::text(step.reason));
  }
  return text + "\n";
}

Json switches_json(const RunTally& tally) {
  Json json{{"switchings", Json::array()}, {"checks", Json::array()}};
  for (const SwitchRecord& record : tally.switchings) {
    const SwitchRequest& request = record.answer.request;
    json["switchings"].push_back({{"lamp", name_of(request.line)},
                                  {"on", request.on},
                                  {"asked_s", to_seconds(request.asked_at.time_since_epoch())},
                                  {"answered_s", to_seconds(record.answer.at.time_since_epoch())},
                                  {"done", record.answer.done},
                                  {"problem", record.problem.data()}});
  }
  for (const CheckEnd& check : tally.checks) {
    json["checks"].push_back({{"lamp", name_of(check.lamp)},
                              {"outcome", name_of(check.report.state)},
                              {"verdict", name_of(check.report.verdict)},
                              {"pairs", check.report.tries},
                              {"image", check.image},
                              {"at_s", check.at_s}});
  }
  return json;
}

std::string switches_text(const RunTally& tally) {
  std::string text = "lamps switched:\n";
  for (const SwitchRecord& record : tally.switchings) {
    const SwitchRequest& request = record.answer.request;
    text += fmt::format("{:>9.3f} s  {} {}: {}\n", to_seconds(request.asked_at.time_since_epoch()),
                        name_of(request.line), request.on ? "on" : "off",
                        record.answer.done
                            ? fmt::format("done at {:.3f} s", to_seconds(record.answer.at.time_since_epoch()))
                            : std::string(record.problem.data()));
  }
  for (const CheckEnd& check : tally.checks) {
    text += fmt::format("{:>9.3f} s  check by the {}: {} ({})\n", check.at_s, name_of(check.lamp),
                        name_of(check.report.state), name_of(check.report.verdict));
  }
  return text + "\n";
}

Json light_json(const LightFigures& light) {
  Json json{{"looks", light.looks}, {"known", light.known}, {"masked", light.masked}};
  json["unanswered"] = Json::object();
  for (const auto& [reason, images] : light.unanswered) json["unanswered"][std::string(reason)] = images;
  if (light.last) {
    const auto& p = light.last->p_WL;
    json["lamp"] = {p.x(), p.y(), p.z()};
    json["lamp_sigma_m"] = std::sqrt(light.last->covariance.trace());
  }
  if (light.compared > 0) {
    json["mean_cm"] = 100.0 * light.mean_m;
    json["worst_cm"] = 100.0 * light.worst_m;
    json["last_cm"] = 100.0 * light.last_m;
  }
  return json;
}

std::string light_text(const LightFigures& light) {
  std::string text = fmt::format("lamp: probes looked at in {} images", light.looks);
  for (const auto& [reason, images] : light.unanswered) text += fmt::format(", {} {}", images, reason);
  text += fmt::format("; known in {} images, masks in {}\n", light.known, light.masked);
  if (light.last) {
    const auto& p = light.last->p_WL;
    text += fmt::format("last at ({:.3f}, {:.3f}, {:.3f}) m, sigma {:.3f} m", p.x(), p.y(), p.z(),
                        std::sqrt(light.last->covariance.trace()));
    if (light.compared > 0) {
      text += fmt::format("; by truth off by {:.1f} cm at the end, {:.1f} cm in the mean, {:.1f} cm at worst",
                          100.0 * light.last_m, 100.0 * light.mean_m, 100.0 * light.worst_m);
    }
    text += "\n";
  }
  return text + "\n";
}

std::string in_words(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.2f}{}", *value, unit) : "never happened";
}

std::string truth_text(const TruthFigures& truth) {
  std::string text = fmt::format(
      "truth, from the first sight on: the object was there in {} images, in view in {:.1f} %; of these the robot "
      "found "
      "{:.1f} %, {:.1f} % with the right box; {} times it found what was not in view\n",
      truth.images, 100.0 * share(truth.in_view, truth.images), 100.0 * share(truth.found, truth.in_view),
      100.0 * share(truth.found_right, truth.in_view), truth.found_nothing);
  text += fmt::format("nearest by its own motion, of the set distance: {}; nearest at all {:.2f} m\n",
                      in_words(truth.nearest_by_own_motion, ""), truth.smallest_distance_m);
  text +=
      fmt::format("lost {} times: command zero after {} at most, standing after {}\n", truth.losses,
                  in_words(truth.longest_command_after_loss_s, " s"), in_words(truth.longest_roll_after_loss_s, " s"));
  return text + fmt::format("object came nearer {} times: command zero after {} at most\n\n", truth.nearings,
                            in_words(truth.longest_command_when_nearer_s, " s"));
}

}  // namespace

std::string summary_json(Robot& robot, const std::string& ended_by) {
  auto& housekeeping = robot.housekeeping();
  const RunTally& tally = housekeeping.tally();
  const auto& capture = robot.links().capture;
  Json json;
  json["images"] = tally.frames - tally.without_image;
  json["config_sha256"] = config::hash(robot.config());
  json["color_sha256"] = config::hash(robot.config().color);
  json["outputs_sha256"] = housekeeping.outputs_sha256();
  json["inputs_sha256"] = housekeeping.inputs_sha256();
  json["decisions_sha256"] = housekeeping.decisions_sha256();
  json["inputs_images"] = tally.pictures;
  json["ended_by"] = ended_by;
  json["problems"] = robot.problems();
  json["frames"] = {
      {"all", tally.frames}, {"without_image", tally.without_image}, {"late", housekeeping.table().frames().late}};
  json["capture"] = {{"images", capture.images.load()},
                     {"timeouts", capture.timeouts.load()},
                     {"no_slot", capture.no_slot.load()},
                     {"corrupt", capture.corrupt.load()},
                     {"disconnected", capture.disconnected.load()}};
  json["found"] = tally.found;
  json["motion"] = motion_json(tally);
  if (const TruthFigures* truth = housekeeping.truth()) json["truth"] = truth_json(*truth);
  if (const PoseFigures* pose = housekeeping.pose_truth()) json["pose"] = pose_json(*pose);
  if (!tally.seek.empty()) json["task"] = seek_json(tally.seek);
  if (const LightFigures* light = housekeeping.light()) json["light"] = light_json(*light);
  if (!tally.switchings.empty() || !tally.checks.empty()) json["switches"] = switches_json(tally);
  json["stages"] = stages_json(housekeeping.table());
  visit_rings(robot.links(), [&json](const char* name, const RingStatistics& ring) {
    json["rings"][name] = {{"capacity", ring.capacity},
                           {"high_water", ring.high_water},
                           {"pushed", ring.pushed},
                           {"dropped", ring.dropped},
                           {"skipped", ring.skipped}};
  });
  return json.dump(1) + "\n";
}

std::string summary_text(Robot& robot, const std::string& ended_by) {
  auto& housekeeping = robot.housekeeping();
  const RunTally& tally = housekeeping.tally();
  const auto& last = tally.last_motion;
  std::string text = fmt::format("\nended by {}: {} images ({} frames without one), object found in {}\n", ended_by,
                                 tally.frames - tally.without_image, tally.without_image, tally.found);
  text += fmt::format(
      "motion: {} beats, {} of them in motion, fastest {:.2f} m/s and {:.2f} rad/s, odometry x {:.2f} m y {:.2f} m "
      "heading {:.2f} rad\n",
      tally.beats, tally.beats_in_motion, tally.fastest_mps, tally.fastest_radps, last.odometry.x_m, last.odometry.y_m,
      last.odometry.heading_rad);
  text += fmt::format("last command {:+.2f} m/s {:+.2f} rad/s ({})\n\n", last.commanded.forward_mps,
                      last.commanded.left_radps, cgsr::text(last.cause));
  for (const std::string& problem : robot.problems()) text += fmt::format("problem: {}\n", problem);
  if (const TruthFigures* truth = housekeeping.truth()) text += truth_text(*truth);
  if (const PoseFigures* pose = housekeeping.pose_truth()) text += pose_text(*pose);
  if (!tally.seek.empty()) text += seek_text(tally.seek);
  if (const LightFigures* light = housekeeping.light()) text += light_text(*light);
  if (!tally.switchings.empty() || !tally.checks.empty()) text += switches_text(tally);
  text += runtime::to_text(housekeeping.table());
  text += "\nring          capacity  high water  pushed  dropped  skipped\n";
  visit_rings(robot.links(), [&text](const char* name, const RingStatistics& ring) {
    text += fmt::format("{:<14}{:>8}{:>12}{:>8}{:>9}{:>9}\n", name, ring.capacity, ring.high_water, ring.pushed,
                        ring.dropped, ring.skipped);
  });
  return text + fmt::format("\nconfiguration {}\n", config::hash(robot.config()));
}

}  // namespace cgsr::robot
