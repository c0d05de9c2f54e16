#include "tools/sim/run_scenario.h"

#include <optional>
#include <string>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "hal/sim/home/simulated_home.h"
#include "src/output/overlay.h"
#include "src/output/plan_view.h"
#include "src/output/text_file.h"
#include "src/output/video_writer.h"

namespace cgsr::sim {
namespace {

std::string row_of(std::uint64_t image, const hal::ImageTruth& t) {
  const auto& q = t.camera_wxyz;
  std::string row = fmt::format(
      "{},{:.6f},{:.5f},{:.5f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.8f},{:.8f},{:.8f},{:.8f},{},{},", image,
      to_seconds(t.stamp.time_since_epoch()), t.robot.x_m, t.robot.y_m, t.robot.heading_rad, t.robot_pitch_rad,
      t.camera_m[0], t.camera_m[1], t.camera_m[2], q[0], q[1], q[2], q[3], t.there ? 1 : 0, t.in_view ? 1 : 0);
  if (!t.there) return row + ",,,,,,,";
  row += fmt::format("{:.4f},{:.4f},{:.4f},{:.4f},", t.object.x_m, t.object.y_m, t.object_mps, t.distance_m);
  return row +
         (t.in_view ? fmt::format("{:.1f},{:.1f},{:.1f},{:.1f}", t.box.x, t.box.y, t.box.width, t.box.height) : ",,,");
}

/// The files of a run, each there when it was asked for.
class Files {
 public:
  static Result<Files> open(const ScenarioRun& run, const hal::Plan& plan, const hal::CameraMode& mode) {
    Files files;
    if (!run.truth.empty()) {
      auto csv = app::TextFile::create(run.truth);
      if (!csv) return tl::unexpected(csv.error());
      if (auto head = csv->add_line(kTruthColumns); !head) return tl::unexpected(head.error());
      files.csv_.emplace(std::move(*csv));
    }
    if (run.video.empty()) return files;
    files.plan_.emplace(plan, mode.height_px & ~1);
    const cv::Size size(mode.width_px + files.plan_->picture_size().width, mode.height_px);
    auto video = app::VideoWriter::create(run.video.string(), size, 1.0 / to_seconds(mode.frame_period));
    if (!video) return tl::unexpected(video.error());
    files.video_.emplace(std::move(*video));
    return files;
  }

  Result<void> add(std::uint64_t number, const ImageView& image, const hal::ImageTruth& truth) {
    if (csv_) {
      if (auto added = csv_->add_line(row_of(number, truth)); !added) return added;
    }
    if (!video_) return {};
    app::PlanFacts facts;
    facts.truth = truth;
    facts.found = truth.in_view;
    cv::Mat left = app::to_bgr(image);
    if (truth.in_view) {
      cv::rectangle(left, cv::Rect2d(truth.box.x, truth.box.y, truth.box.width, truth.box.height), {230, 150, 60}, 1);
    }
    const cv::Mat& right = plan_->draw(facts);
    cv::hconcat(left(cv::Rect(0, 0, left.cols, right.rows)), right, side_by_side_);
    return video_->add(side_by_side_);
  }

  Result<void> close() { return video_ ? video_->close() : Result<void>{}; }

 private:
  std::optional<app::TextFile> csv_;
  std::optional<app::VideoWriter> video_;
  std::optional<app::PlanView> plan_;
  cv::Mat side_by_side_;
};

}  // namespace

Result<ScenarioPlayed> run_scenario(const ScenarioRun& run) {
  hal::SimulationParameters parameters;
  parameters.scenario = run.scenario.string();
  parameters.seed = run.seed;
  parameters.threads = run.threads;
  parameters.width_px = run.width_px;
  parameters.height_px = run.height_px;
  auto home = SimulatedHome::make(parameters);
  if (!home) return tl::unexpected(home.error());
  const auto camera = (*home)->take_camera();
  const auto mode = camera->start();
  if (!mode) return tl::unexpected(mode.error());
  auto files = Files::open(run, (*home)->plan(), *mode);
  if (!files) return tl::unexpected(files.error());

  ScenarioPlayed played;
  MonoTime due{(*home)->image_delay()};
  const MonoTime end = run.duration_s > 0.0 ? due + seconds(run.duration_s) : MonoTime::max();
  for (; due < end; due += mode->frame_period) {
    (*home)->advance_to(due);
    const auto image = camera->next_image(due);
    if (!image) {
      if (image.error() == hal::CaptureFailure::kEndOfStream) break;
      continue;  // the script dropped it
    }
    const auto truth = (*home)->truth(image->stamp());
    if (!truth) continue;
    ++played.images;
    played.images_with_object += truth->in_view ? 1 : 0;
    played.seconds = to_seconds(image->stamp().time_since_epoch());
    if (auto added = files->add(image->sequence(), image->view(), *truth); !added) return tl::unexpected(added.error());
  }
  if (auto closed = files->close(); !closed) return tl::unexpected(closed.error());
  return played;
}

}  // namespace cgsr::sim
