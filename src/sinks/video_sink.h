#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "pipeline/color/track/light_history.h"
#include "pipeline/runtime/stage_table.h"
#include "src/output/overlay.h"
#include "src/output/video_writer.h"
#include "src/sinks/ground_truth.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// A film of what the robot saw and made of it: the overlay of each image, and beside it another drawing where there is one.
class VideoSink final : public Sink {
 public:
  /// \param truth  of the image at hand; null: none. Outlives the sink. \param beside  may be null.
  static Result<std::unique_ptr<VideoSink>> create(const std::string& path, const hal::CameraMode& mode,
                                                   const runtime::Schedule& schedule, const GroundTruth* truth,
                                                   std::unique_ptr<SidePicture> beside);

  Result<void> on_image(const ImageReport& report) override;
  Result<void> finish() override { return video_.close(); }

 private:
  VideoSink(app::Overlay overlay, app::VideoWriter video, const runtime::Schedule& schedule, const GroundTruth* truth,
            std::unique_ptr<SidePicture> beside);
  [[nodiscard]] app::OverlayFacts facts_of(const ImageReport& report);

  app::Overlay overlay_;
  app::VideoWriter video_;
  runtime::Schedule schedule_;
  const GroundTruth* truth_;
  std::unique_ptr<SidePicture> beside_;
  color::LightHistory lights_;
  cv::Mat side_by_side_;
};

/// \return the lines below an overlay: one line for each output that has something to say, last what the stages took.
std::vector<std::string> overlay_lines(const ImageReport& report, const runtime::Schedule& schedule);

}  // namespace cgsr::sinks
