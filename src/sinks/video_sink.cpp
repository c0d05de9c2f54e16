#include "src/sinks/video_sink.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "platform/description/text.h"

namespace cgsr::sinks {
namespace {

std::string task_line(const ImageReport& report) {
  const MotionStatus& motion = report.motion;
  return fmt::format("{}   commanded {:+.2f} m/s {:+.2f} rad/s   {}", report.frame.decision.value.state,
                     motion.commanded.forward_mps, motion.commanded.left_radps,
                     motion.cause == StopCause::kNone ? "free to move" : to_string(motion.cause));
}

std::string pose_line(const stages::PoseEstimate& pose) {
  if (pose.seeks_pose()) return fmt::format("{}: {}", pose.sought(), pose.state());
  return fmt::format("pose {}   x {:.2f} y {:.2f} m  heading {:.1f} deg   {} matches", pose.state(), pose.robot.x_m,
                     pose.robot.y_m, pose.robot.heading_rad * 180.0 / std::numbers::pi, pose.camera.correction.matches);
}

std::string lamp_line(const stages::LampReport& lamp, const stages::ShadowMasks& shade) {
  const auto reason = reason_of(lamp);
  std::string line = fmt::format("probes: {}   ", reason.empty() ? "shadows visible" : reason);
  if (lamp.known) {
    const auto& p = lamp.lamp.p_WL;
    line += fmt::format("lamp {:.2f} {:.2f} {:.2f} m, sigma {:.3f}   ", p.x(), p.y(), p.z(),
                        std::sqrt(lamp.lamp.covariance.trace()));
  }
  return line + fmt::format("shadow masks: {}", to_string(shade.status));
}

// The outputs that are drawn, or whose line says more than their description. Any other one is written as described.

std::string line_of(std::string_view, const ImageReport&, const runtime::Aged<stages::TrackedObjects>&) {
  return "";  // its box and light are drawn
}

std::string line_of(std::string_view, const ImageReport& report, const runtime::Aged<stages::Decision>&) {
  return task_line(report);
}

std::string line_of(std::string_view, const ImageReport&, const runtime::Aged<stages::PoseEstimate>& pose) {
  return pose.value.has_map ? pose_line(pose.value) : "";
}

std::string line_of(std::string_view, const ImageReport& report, const runtime::Aged<stages::LampReport>& lamp) {
  return lamp.value.has_board ? lamp_line(lamp.value, report.frame.shade.value) : "";
}

std::string line_of(std::string_view, const ImageReport&, const runtime::Aged<stages::ShadowMasks>&) {
  return "";  // drawn, and in the lamp's line
}

std::string line_of(std::string_view, const ImageReport&, const runtime::Aged<stages::IdentifiedPeople>&) {
  return "";  // drawn
}

std::vector<app::OverlayPerson> people_of(const runtime::Aged<stages::IdentifiedPeople>& people) {
  std::vector<app::OverlayPerson> drawn;
  if (!people.fresh()) return drawn;
  for (const person::SeenFace& face : people.value.seen_faces()) {
    const std::string who = !face.compared ? "?" : face.person ? fmt::format("{}", *face.person) : "stranger";
    drawn.push_back({face.box, who, false});
  }
  const person::PersonSighting& person = people.value.person;
  if (!person.person) return drawn;
  const std::string who = *person.person == person::kStranger ? "stranger" : fmt::format("person {}", *person.person);
  drawn.push_back({person.box, fmt::format("{} by {}", who, to_string(person.source)), true});
  return drawn;
}

template <class Output>
std::string line_of(std::string_view name, const ImageReport&, const runtime::Aged<Output>& output) {
  if (!output.ever()) return "";
  std::string line(name);
  line += ": ";
  append_text(line, output.value);
  return line;
}

constexpr double kLeastShown_us = 2.0;

std::string stage_times(const runtime::FrameRecord& record, const runtime::Schedule& schedule) {
  std::string line = "stages, us:";
  for (std::size_t i = 0; i < schedule.rows().size(); ++i) {
    const double elapsed_us = static_cast<double>(record.stages[i].elapsed_ns) * 1e-3;
    // A stage that a robot has not, or that had no turn: the line is short.
    if (elapsed_us >= kLeastShown_us) line += fmt::format("  {} {:.0f}", schedule.rows()[i].name, elapsed_us);
  }
  return line;
}

}  // namespace

std::vector<std::string> overlay_lines(const ImageReport& report, const runtime::Schedule& schedule) {
  std::vector<std::string> lines;
  stages::for_each_output(report.frame, [&](std::string_view name, std::string_view, const auto& output) {
    std::string line = line_of(name, report, output);
    if (!line.empty()) lines.push_back(std::move(line));
  });
  lines.push_back(stage_times(report.record, schedule));
  return lines;
}

Result<std::unique_ptr<VideoSink>> VideoSink::create(const std::string& path, const hal::CameraMode& mode,
                                                     const runtime::Schedule& schedule, const GroundTruth* truth,
                                                     std::unique_ptr<SidePicture> beside) {
  app::Overlay overlay(mode.width_px, mode.height_px);
  cv::Size size = overlay.picture_size();
  if (beside) size.width += beside->picture_size().width;
  auto video = app::VideoWriter::create(path, size, 1.0 / to_seconds(mode.frame_period));
  if (!video) return tl::unexpected(video.error());
  return std::unique_ptr<VideoSink>(
      new VideoSink(std::move(overlay), std::move(*video), schedule, truth, std::move(beside)));
}

VideoSink::VideoSink(app::Overlay overlay, app::VideoWriter video, const runtime::Schedule& schedule,
                     const GroundTruth* truth, std::unique_ptr<SidePicture> beside)
    : overlay_(std::move(overlay)),
      video_(std::move(video)),
      schedule_(schedule),
      truth_(truth),
      beside_(std::move(beside)) {}

app::OverlayFacts VideoSink::facts_of(const ImageReport& report) {
  const color::TrackedObject& object = report.frame.objects.value.first().object;
  app::OverlayFacts facts;
  facts.image_number = report.record.image_sequence;
  if (object.found) facts.box = object.box;
  if (object.found) facts.light = object.exact_light;
  facts.plurality = lights_.add(report.record.stamp, object.found ? std::optional(object.light) : std::nullopt);
  facts.divergence = object.divergence;
  facts.shade = report.picture->masks.get();
  if (truth_ != nullptr) facts.truth = truth_->box;
  facts.people = people_of(report.frame.people);
  facts.lines = overlay_lines(report, schedule_);
  return facts;
}

Result<void> VideoSink::on_image(const ImageReport& report) {
  if (report.picture == nullptr) return {};
  const cv::Mat& overlay = overlay_.draw(report.picture->image.view(), facts_of(report));
  if (!beside_) return video_.add(overlay);
  cv::hconcat(overlay, beside_->draw(report), side_by_side_);
  return video_.add(side_by_side_);
}

}  // namespace cgsr::sinks
