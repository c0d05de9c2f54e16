#include "src/sinks/statistics_sink.h"

#include <algorithm>
#include <cmath>

#include "platform/description/json.h"
#include "src/sinks/statistics_summary.h"

namespace cgsr::sinks {
namespace {

double seconds_of(MonoTime stamp) {
  return to_seconds(stamp.time_since_epoch());
}

}  // namespace

Result<void> StatisticsSink::on_image(const ImageReport& report) {
  ++run_.frames;
  table_.add(report.record);
  run_.found += report.frame.objects.value.first().object.found ? 1 : 0;
  run_.last_pose = report.frame.pose.value;
  const stages::Decision& decision = report.frame.decision.value;
  if (run_.task.empty() || run_.task.back().state != decision.state) {
    run_.task.push_back(
        {decision.state, decision.reason, report.record.image_sequence, seconds_of(report.record.stamp)});
  }
  count_lamp(report);
  count_outputs(report);
  return {};
}

void StatisticsSink::count_outputs(const ImageReport& report) {
  std::size_t place = 0;
  stages::for_each_output(report.frame, [&](std::string_view name, std::string_view, const auto& output) {
    if (place == run_.outputs.size()) run_.outputs.push_back({name, 0, ""});
    OutputStatistics& statistics = run_.outputs[place++];
    if (!output.fresh()) return;
    ++statistics.updates;
    statistics.last.clear();
    append_json(statistics.last, output.value);
  });
}

void StatisticsSink::count_lamp(const ImageReport& report) {
  const stages::LampReport& lamp = report.frame.lamp.value;
  if (!lamp.has_board) return;
  count_check(report, illumination::CheckedLamp::kProbeLamp, lamp.probes_check);
  count_check(report, illumination::CheckedLamp::kRoomLamp, lamp.lamp_proof);
  if (report.frame.lamp.fresh()) {
    ++run_.lamp.looks;
    if (const auto reason = reason_of(lamp); !reason.empty()) ++run_.lamp.unanswered[reason];
  }
  run_.lamp.masked += report.frame.shade.value.status == stages::ShadeStatus::kMasked ? 1 : 0;
  if (!lamp.known) return;
  ++run_.lamp.known;
  run_.lamp.last = lamp.lamp;
}

void StatisticsSink::count_check(const ImageReport& report, illumination::CheckedLamp lamp,
                                 const illumination::CheckReport& check) {
  using illumination::CheckState;
  auto& before = checks_[static_cast<std::size_t>(lamp)];
  if (check.state == before) return;
  before = check.state;
  if (check.state != CheckState::kPassed && check.state != CheckState::kFailed && check.state != CheckState::kFault) {
    return;
  }
  run_.checks.push_back({lamp, check, report.record.image_sequence, seconds_of(report.record.stamp)});
}

Result<void> StatisticsSink::on_missing_image(const runtime::FrameRecord& record) {
  ++run_.frames;
  ++run_.without_image;
  table_.add(record);
  return {};
}

Result<void> StatisticsSink::on_control_cycle(const MotionStatus& status) {
  ++run_.control_cycles;
  const bool moves = status.sent && (status.commanded.forward_mps != 0.0 || status.commanded.left_radps != 0.0);
  run_.cycles_in_motion += moves ? 1 : 0;
  run_.fastest_mps = std::max(run_.fastest_mps, std::abs(status.commanded.forward_mps));
  run_.fastest_radps = std::max(run_.fastest_radps, std::abs(status.commanded.left_radps));
  run_.last_motion = status;
  return {};
}

Result<void> StatisticsSink::on_switching(const SwitchRecord& record) {
  run_.switchings.push_back(record);
  return {};
}

void StatisticsSink::summarize(Summary& summary) {
  add_run_statistics(run_, table_, summary);
}

}  // namespace cgsr::sinks
