// The step that opens every output before the first image: who reads what the robot says of itself.
#include "src/boot/robot_plan.h"
#include "src/output/overlay.h"
#include "src/sinks/csv_sink.h"
#include "src/sinks/digest_sink.h"
#include "src/sinks/log_sink.h"
#include "src/sinks/plan_picture.h"
#include "src/sinks/profile_sink.h"
#include "src/sinks/recording_sink.h"
#include "src/sinks/trace_sink.h"
#include "src/sinks/video_sink.h"
#include "src/tasks/ring_report.h"

namespace cgsr::boot {
namespace {

double set_distance_m(const config::Robot& config) {
  const bool keeps_distance = config.task.kind == config::TaskKind::kFollow || config.follows_person();
  return keeps_distance ? config.follow.distance_m : 0.0;
}

/// The home from above beside the film; null: nobody knows it.
std::unique_ptr<sinks::SidePicture> plan_of(const RobotState& state) {
  if (state.outputs.truth == nullptr) return nullptr;
  const hal::CameraMode& mode = state.devices.mode;
  const int height_px = app::Overlay(mode.width_px, mode.height_px).picture_size().height;
  return std::make_unique<sinks::PlanPicture>(state.devices.simulation->plan(), *state.outputs.truth, height_px,
                                              set_distance_m(state.setup.config));
}

}  // namespace

Result<void> open_outputs(RobotState& state) {
  Outputs& outputs = state.outputs;
  const RunOptions& options = state.setup.options;
  const runtime::Schedule& schedule = state.vision.runner->schedule();
  outputs.statistics = &outputs.sinks.add(std::make_unique<sinks::StatisticsSink>(schedule));
  outputs.sinks.add(std::make_unique<sinks::DigestSink>(!state.setup.live()));
  outputs.sinks.add(std::make_unique<sinks::LogSink>());
  if (state.setup.config.simulated_camera()) {
    outputs.truth = &outputs.sinks.add(std::make_unique<sinks::TruthSink>(
        *state.devices.simulation, set_distance_m(state.setup.config), options.observer));
  }
  if (options.profile || !options.status.empty()) {
    outputs.sinks.add(std::make_unique<sinks::ProfileSink>(
        schedule, options.status, [&links = state.links] { return tasks::rings_json(links); }));
  }
  const sinks::GroundTruth* const truth = outputs.truth != nullptr ? &outputs.truth->ground_truth() : nullptr;
  if (!options.csv.empty()) {
    auto csv = sinks::CsvSink::create(options.csv, truth);
    if (!csv) return tl::unexpected(csv.error());
    outputs.sinks.add(std::move(*csv));
  }
  if (!options.trace.empty()) {
    auto trace = sinks::TraceSink::create(options.trace, schedule);
    if (!trace) return tl::unexpected(trace.error());
    outputs.sinks.add(std::move(*trace));
  }
  if (!options.recording.empty()) {
    // Pictures of people are personal data.
    const bool images = options.record_images || !state.setup.config.person.enabled();
    if (!images) state.report.notes.emplace_back("the recording leaves the images out: --record-images keeps them");
    auto recording = sinks::RecordingSink::create(options.recording, images);
    if (!recording) return tl::unexpected(recording.error());
    outputs.sinks.add(std::move(*recording));
  }
  if (!options.video.empty()) {
    auto video = sinks::VideoSink::create(options.video, state.devices.mode, schedule, truth, plan_of(state));
    if (!video) return tl::unexpected(video.error());
    outputs.sinks.add(std::move(*video));
  }
  return {};
}

}  // namespace cgsr::boot
