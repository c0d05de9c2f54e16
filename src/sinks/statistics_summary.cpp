#include "src/sinks/statistics_summary.h"

#include <string>

#include <fmt/format.h>

#include "src/sinks/event_text.h"

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

Json event_json(const EventRecord& record) {
  Json json{{"image", record.image},
            {"at_s", record.at_s},
            {"source", record.event.source},
            {"state", record.event.state},
            {"reason", record.event.reason}};
  for (std::size_t i = 0; i < record.event.number_count; ++i) {
    json["numbers"][std::string(record.event.numbers[i].name)] = record.event.numbers[i].value;
  }
  return json;
}

void add_events(const RunStatistics& run, Summary& summary) {
  Json json = Json::array();
  for (const EventRecord& record : run.events) json.push_back(event_json(record));
  summary.json["events"] = std::move(json);
  summary.json["earlier_events"] = run.earlier_events;
  if (run.events.empty()) return;
  summary.text += "events:\n";
  if (run.earlier_events > 0) summary.text += fmt::format("   ({} before)\n", run.earlier_events);
  for (const EventRecord& record : run.events) {
    summary.text += fmt::format("{:>8} {:>7.1f} s  {}\n", record.image, record.at_s, text_of(record.event));
  }
  summary.text += "\n";
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
  if (run.switchings.empty()) return;
  Json json = Json::array();
  summary.text += "lamps switched:\n";
  for (const SwitchRecord& record : run.switchings) {
    const stages::SwitchRequest& request = record.answer.request;
    json.push_back(switching_json(record));
    summary.text += fmt::format("{:>9.3f} s  {} {}: {}\n", seconds_of(request.asked_at), to_string(request.line),
                                request.on ? "on" : "off",
                                record.answer.done ? fmt::format("done at {:.3f} s", seconds_of(record.answer.at))
                                                   : std::string(record.problem.data()));
  }
  summary.text += "\n";
  summary.json["switchings"] = std::move(json);
}

/// Only what is not the same in every image: texts and choices by what they said, flags, and numbers that may be missing.
Json images_json(const std::vector<FieldStatistics>& fields) {
  Json json = Json::object();
  for (const FieldStatistics& field : fields) {
    if (!field.words.empty()) {
      json[field.name] = field.words;
    } else if (field.kind == Field::Kind::kFlag || field.optional) {
      json[field.name] = field.images;
    }
  }
  return json;
}

void add_outputs(const RunStatistics& run, Summary& summary) {
  Json outputs = Json::object();
  for (const OutputStatistics& output : run.outputs) {
    outputs[std::string(output.name)] = {{"updates", output.updates},
                                         {"images", images_json(output.fields)},
                                         {"last", output.last.empty() ? Json() : Json::parse(output.last)}};
    for (const FieldStatistics& field : output.fields) {
      if (field.words.empty()) continue;
      summary.text += fmt::format("{}, {} by images:", output.name, field.name);
      for (const auto& [word, images] : field.words) summary.text += fmt::format(" {} {};", word, images);
      summary.text += "\n";
    }
  }
  summary.text += "\n";
  summary.json["outputs"] = std::move(outputs);
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
  add_events(run, summary);
  add_switches(run, summary);
  add_outputs(run, summary);
  summary.json["stages"] = stages_json(table);
  summary.text += runtime::to_text(table);
}

}  // namespace cgsr::sinks
