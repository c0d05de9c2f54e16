#include "src/sinks/recording_sink.h"

#include <utility>

#include <fmt/format.h>

#include "platform/description/json.h"
#include "src/sinks/ros_image.h"

namespace cgsr::sinks {
namespace {

// The index of each topic, in the order of channels().
enum Topic : std::size_t { kObjects, kDecision, kMotion, kPose, kLamp, kShade, kImage };

template <class Output>
McapChannel channel_of(const std::string& name, std::string_view meaning) {
  return json_channel("/cgsr/" + name, "cgsr/" + name, json_schema<Output>("cgsr/" + name, meaning));
}

std::vector<McapChannel> channels() {
  return {channel_of<stages::TrackedObjects>("objects", "The tracked object."),
          channel_of<stages::Decision>("decision", "What the task decided."),
          channel_of<MotionStatus>("motion", "A cycle of the motion loop."),
          channel_of<stages::PoseEstimate>("pose", "The estimated pose."),
          channel_of<stages::LampReport>("lamp", "What the probes say of the lamp."),
          channel_of<stages::ShadowMasks>("shade", "The state of the shadow masks."),
          compressed_image_channel("/camera/image/compressed")};
}

}  // namespace

Result<std::unique_ptr<RecordingSink>> RecordingSink::create(const std::string& path) {
  auto recorder = Recorder::create(path, channels());
  if (!recorder) return tl::unexpected(recorder.error());
  return std::unique_ptr<RecordingSink>(new RecordingSink(std::move(*recorder)));
}

template <class Output>
void RecordingSink::post(std::size_t channel, MonoTime stamp, const Output& output) {
  message_.clear();
  append_json(message_, output);
  recorder_->post(channel, stamp, message_);
}

Result<void> RecordingSink::on_image(const ImageReport& report) {
  const MonoTime stamp = report.record.stamp;
  post(kObjects, stamp, report.frame.objects.value);
  post(kDecision, stamp, report.frame.decision.value);
  post(kPose, stamp, report.frame.pose.value);
  post(kLamp, stamp, report.frame.lamp.value);
  post(kShade, stamp, report.frame.shade.value);
  if (report.picture != nullptr) recorder_->post(kImage, stamp, report.picture->image.view());
  return recorder_->step();
}

Result<void> RecordingSink::on_control_cycle(const MotionStatus& status) {
  post(kMotion, status.stamp, status);
  return {};
}

void RecordingSink::summarize(Summary& summary) {
  auto& json = summary.json["recording"];
  summary.text += "\nrecording                     messages    lost       bytes\n";
  for (const TopicStatistics& topic : recorder_->statistics()) {
    json[topic.topic] = {{"written", topic.written}, {"lost", topic.lost}, {"bytes", topic.bytes}};
    summary.text += fmt::format("{:<28}{:>10}{:>8}{:>12}\n", topic.topic, topic.written, topic.lost, topic.bytes);
  }
}

}  // namespace cgsr::sinks
