#include "src/sinks/recording_sink.h"

#include <utility>

#include <fmt/format.h>

#include "platform/description/json.h"
#include "src/sinks/ros_image.h"

namespace cgsr::sinks {
namespace {

template <class Output>
McapChannel channel_of(const std::string& name, std::string_view meaning) {
  return json_channel("/cgsr/" + name, "cgsr/" + name, json_schema<Output>("cgsr/" + name, meaning));
}

/// The outputs in their order, then events, motion, and the images.
std::vector<McapChannel> channels(bool with_images) {
  std::vector<McapChannel> all;
  const stages::FrameResult frame;
  stages::for_each_output(frame, [&all](std::string_view name, std::string_view meaning, const auto& output) {
    all.push_back(channel_of<std::remove_cvref_t<decltype(output.value)>>(std::string(name), meaning));
  });
  all.push_back(channel_of<stages::Event>("events", "A change of a state, of a stage or the task."));
  all.push_back(channel_of<MotionStatus>("motion", "A cycle of the motion loop."));
  if (with_images) all.push_back(compressed_image_channel("/camera/image/compressed"));
  return all;
}

}  // namespace

Result<std::unique_ptr<RecordingSink>> RecordingSink::create(const std::string& path, bool with_images) {
  std::vector<McapChannel> all = channels(with_images);
  const std::size_t outputs = all.size() - (with_images ? 3 : 2);
  auto recorder = Recorder::create(path, std::move(all));
  if (!recorder) return tl::unexpected(recorder.error());
  return std::unique_ptr<RecordingSink>(new RecordingSink(std::move(*recorder), outputs, with_images));
}

template <class Output>
void RecordingSink::post(std::size_t channel, MonoTime stamp, const Output& output) {
  message_.clear();
  append_json(message_, output);
  recorder_->post(channel, stamp, message_);
}

Result<void> RecordingSink::on_image(const ImageReport& report) {
  const MonoTime stamp = report.record.stamp;
  std::size_t channel = 0;
  stages::for_each_output(report.frame, [&](std::string_view, std::string_view, const auto& output) {
    post(channel++, stamp, output.value);
  });
  stages::for_each_event(report.frame, [&](const stages::Event& event) { post(events(), stamp, event); });
  if (report.picture != nullptr && with_images_) recorder_->post(images(), stamp, report.picture->image.view());
  return recorder_->step();
}

// While no images come, what the motion loop did is what a reader of the recording looks for.
Result<void> RecordingSink::on_missing_image(const runtime::FrameRecord& /*record*/) {
  return recorder_->step();
}

Result<void> RecordingSink::on_control_cycle(const MotionStatus& status) {
  post(motion(), status.stamp, status);
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
