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

constexpr std::size_t kMaxWords = 64;  // of one field; more are no states

/// Counts what the fields of one output are, in their order; a list has another length every time and is left out.
class FieldCounter {
 public:
  [[maybe_unused]] static constexpr bool kOfType = false;  // asked where an output has a list

  explicit FieldCounter(std::vector<FieldStatistics>& fields) : fields_(fields) {}

  void field(const Field& field) {
    if (lists_ > 0) return;
    if (place_ == fields_.size()) fields_.push_back({std::string(field.name), field.kind, field.optional, 0, {}});
    FieldStatistics& statistics = fields_[place_++];
    if (!field.present) return;
    if (field.kind != Field::Kind::kFlag || field.integer != 0) ++statistics.images;
    if (field.kind == Field::Kind::kText || field.kind == Field::Kind::kChoice) count(statistics.words, field.text);
  }
  void begin_section(std::string_view, std::string_view, bool, bool) {}
  void end_section() {}
  void begin_list(std::string_view, std::string_view, std::size_t) { ++lists_; }
  void end_list() { --lists_; }
  void begin_element() {}
  void end_element() {}

 private:
  static void count(std::map<std::string, std::uint64_t>& words, std::string_view word) {
    if (word.empty()) return;
    const std::string key(word);
    const auto known = words.find(key);
    if (known != words.end()) {
      ++known->second;
    } else if (words.size() < kMaxWords) {
      words.emplace(key, 1);
    }
  }

  std::vector<FieldStatistics>& fields_;
  std::size_t place_ = 0;
  int lists_ = 0;
};

}  // namespace

Result<void> StatisticsSink::on_image(const ImageReport& report) {
  ++run_.frames;
  table_.add(report.record);
  run_.found += report.frame.objects.value.first().object.found ? 1 : 0;
  run_.last_pose = report.frame.pose.value;
  keep_events(report);
  count_outputs(report);
  return {};
}

void StatisticsSink::count_outputs(const ImageReport& report) {
  std::size_t place = 0;
  stages::for_each_output(report.frame, [&](std::string_view name, std::string_view, const auto& output) {
    if (place == run_.outputs.size()) run_.outputs.push_back({name, 0, "", {}});
    OutputStatistics& statistics = run_.outputs[place++];
    if (!output.fresh()) return;
    ++statistics.updates;
    statistics.last.clear();
    append_json(statistics.last, output.value);
    FieldCounter counter(statistics.fields);
    read_fields(output.value, counter);
  });
}

// What the robot says is rare, and what somebody looks for after a long run.
void StatisticsSink::keep_events(const ImageReport& report) {
  const auto is_not_said = [](const EventRecord& record) { return record.event.source != "says"; };
  stages::for_each_event(report.frame, [&](const stages::Event& event) {
    run_.events.push_back({event, report.record.image_sequence, seconds_of(report.record.stamp)});
    if (run_.events.size() <= RunStatistics::kMaxEvents) return;
    const auto oldest = std::ranges::find_if(run_.events, is_not_said);
    run_.events.erase(oldest == run_.events.end() ? run_.events.begin() : oldest);
    ++run_.earlier_events;
  });
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
