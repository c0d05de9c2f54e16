#pragma once

#include "src/output/plan_view.h"
#include "src/sinks/truth_sink.h"

namespace cgsr::sinks {

/// The simulated home from above, with what was really there at each image and where the robot's own estimate is.
class PlanPicture final : public SidePicture {
 public:
  /// \param truth  outlives it. \param height_px  of the drawing. \param set_distance_m  drawn around the robot; 0: not.
  PlanPicture(const hal::Plan& plan, const TruthSink& truth, int height_px, double set_distance_m)
      : view_(plan, height_px), truth_(truth), set_distance_m_(set_distance_m) {}

  [[nodiscard]] cv::Size picture_size() const override { return view_.picture_size(); }
  const cv::Mat& draw(const ImageReport& report) override;

 private:
  app::PlanView view_;
  const TruthSink& truth_;
  double set_distance_m_;
};

}  // namespace cgsr::sinks
