#pragma once

#include <memory>
#include <string>

#include "src/sinks/recorder.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// A recording of the run in MCAP, which Foxglove opens: the described outputs of the stages, events and the motion loop as JSON, a topic each,
/// and the images as JPEG. What finds no room is lost and counted.
class RecordingSink final : public Sink {
 public:
  /// \param with_images  else there is no topic for them.
  static Result<std::unique_ptr<RecordingSink>> create(const std::string& path, bool with_images = true);

  Result<void> on_image(const ImageReport& report) override;
  Result<void> on_missing_image(const runtime::FrameRecord& record) override;
  Result<void> on_control_cycle(const MotionStatus& status) override;
  Result<void> finish() override { return recorder_->close(); }
  void summarize(Summary& summary) override;

 private:
  RecordingSink(std::unique_ptr<Recorder> recorder, std::size_t outputs, bool with_images)
      : recorder_(std::move(recorder)), outputs_(outputs), with_images_(with_images) {}

  // The channels: those of the outputs are their places in the list.
  [[nodiscard]] std::size_t events() const { return outputs_; }
  [[nodiscard]] std::size_t motion() const { return outputs_ + 1; }
  [[nodiscard]] std::size_t images() const { return outputs_ + 2; }

  template <class Output>
  void post(std::size_t channel, MonoTime stamp, const Output& output);

  std::unique_ptr<Recorder> recorder_;
  std::size_t outputs_;
  bool with_images_;
  std::string message_;
};

}  // namespace cgsr::sinks
