#include "src/sinks/statistics_summary.h"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace cgsr::sinks {
namespace {

using Json = nlohmann::ordered_json;

double seconds_of(MonoTime stamp) {
  return to_seconds(stamp.time_since_epoch());
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

void add_motion(const RunStatistics& run, Summary& summary) {
  const MotionStatus& last = run.last_motion;
  summary.json["motion"] = {{"control_cycles", run.control_cycles},
                            {"cycles_in_motion", run.cycles_in_motion},
                            {"fastest_mps", run.fastest_mps},
                            {"fastest_radps", run.fastest_radps},
                            {"last_command", {last.commanded.forward_mps, last.commanded.left_radps}},
                            {"odometry", {last.odometry.x_m, last.odometry.y_m, last.odometry.heading_rad}},
                            {"stop_cause", to_string(last.cause)},
                            {"latched", to_string(last.latched)}};
  summary.text += fmt::format(
      "motion: {} control cycles, {} of them in motion, fastest {:.2f} m/s and {:.2f} rad/s, odometry x {:.2f} m y "
      "{:.2f} m heading {:.2f} rad\nlast command {:+.2f} m/s {:+.2f} rad/s ({})\n\n",
      run.control_cycles, run.cycles_in_motion, run.fastest_mps, run.fastest_radps, last.odometry.x_m,
      last.odometry.y_m, last.odometry.heading_rad, last.commanded.forward_mps, last.commanded.left_radps,
      to_string(last.cause));
}

void add_task(const RunStatistics& run, Summary& summary) {
  if (run.task.empty()) return;
  Json json = Json::array();
  summary.text += "task, state by state:\n";
  for (const TaskStep& step : run.task) {
    json.push_back({{"state", step.state}, {"reason", step.reason}, {"image", step.image}, {"at_s", step.at_s}});
    summary.text += fmt::format("{:>8} {:>7.1f} s  {:<32} {}\n", step.image, step.at_s, step.state, step.reason);
  }
  summary.text += "\n";
  summary.json["task"] = std::move(json);
}

void add_lamp(const LampStatistics& lamp, Summary& summary) {
  if (lamp.looks == 0) return;
  Json json{{"looks", lamp.looks}, {"known", lamp.known}, {"masked", lamp.masked}, {"unanswered", Json::object()}};
  summary.text += fmt::format("lamp: probes examined in {} images", lamp.looks);
  for (const auto& [reason, images] : lamp.unanswered) {
    json["unanswered"][std::string(reason)] = images;
    summary.text += fmt::format(", {} {}", images, reason);
  }
  summary.text += fmt::format("; known in {} images, masks in {}\n", lamp.known, lamp.masked);
  if (lamp.last) {
    const auto& p = lamp.last->p_WL;
    const double sigma_m = std::sqrt(lamp.last->covariance.trace());
    json["lamp"] = {p.x(), p.y(), p.z()};
    json["lamp_sigma_m"] = sigma_m;
    summary.text += fmt::format("last at ({:.3f}, {:.3f}, {:.3f}) m, sigma {:.3f} m\n", p.x(), p.y(), p.z(), sigma_m);
  }
  summary.text += "\n";
  summary.json["light"] = std::move(json);
}

Json switching_json(const SwitchRecord& record) {
  const stages::SwitchRequest& request = record.answer.request;
  return {{"lamp", to_string(request.line)},
          {"on", request.on},
          {"requested_s", seconds_of(request.asked_at)},
          {"answered_s", seconds_of(record.answer.at)},
          {"done", record.answer.done},
          {"problem", record.problem.data()}};
}

void add_switches(const RunStatistics& run, Summary& summary) {
  if (run.switchings.empty() && run.checks.empty()) return;
  Json json{{"switchings", Json::array()}, {"checks", Json::array()}};
  summary.text += "lamps switched:\n";
  for (const SwitchRecord& record : run.switchings) {
    const stages::SwitchRequest& request = record.answer.request;
    json["switchings"].push_back(switching_json(record));
    summary.text += fmt::format("{:>9.3f} s  {} {}: {}\n", seconds_of(request.asked_at), to_string(request.line),
                                request.on ? "on" : "off",
                                record.answer.done ? fmt::format("done at {:.3f} s", seconds_of(record.answer.at))
                                                   : std::string(record.problem.data()));
  }
  for (const CheckEnd& check : run.checks) {
    json["checks"].push_back({{"lamp", to_string(check.lamp)},
                              {"outcome", to_string(check.report.state)},
                              {"verdict", to_string(check.report.verdict)},
                              {"pairs", check.report.tries},
                              {"image", check.image},
                              {"at_s", check.at_s}});
    summary.text += fmt::format("{:>9.3f} s  check by the {}: {} ({})\n", check.at_s, to_string(check.lamp),
                                to_string(check.report.state), to_string(check.report.verdict));
  }
  summary.text += "\n";
  summary.json["switches"] = std::move(json);
}

Json outputs_json(const RunStatistics& run) {
  Json outputs = Json::object();
  for (const OutputStatistics& output : run.outputs) {
    outputs[std::string(output.name)] = {{"updates", output.updates},
                                         {"last", output.last.empty() ? Json() : Json::parse(output.last)}};
  }
  return outputs;
}

}  // namespace

void add_run_statistics(const RunStatistics& run, const runtime::StageTable& table, Summary& summary) {
  const std::uint64_t images = run.frames - run.without_image;
  summary.json["images"] = images;
  summary.json["frames"] = {{"all", run.frames}, {"without_image", run.without_image}, {"late", table.frames().late}};
  summary.json["found"] = run.found;
  summary.text +=
      fmt::format("{} images ({} frames without one), object found in {}\n", images, run.without_image, run.found);
  add_motion(run, summary);
  add_task(run, summary);
  add_lamp(run.lamp, summary);
  add_switches(run, summary);
  summary.json["outputs"] = outputs_json(run);
  summary.json["stages"] = stages_json(table);
  summary.text += runtime::to_text(table);
}

}  // namespace cgsr::sinks
