#pragma once

#include <deque>
#include <optional>

#include <opencv2/core.hpp>

#include "hal/drive.h"
#include "hal/simulation.h"

namespace cgsr::app {

/// What is drawn on the plan of one image.
struct PlanFacts {
  hal::ImageTruth truth;
  bool found = false;                      ///< the robot sees the object: it is drawn full, else as an outline.
  std::optional<hal::FloorPose> believed;  ///< where the robot believes to be: an outline.
  hal::Twist commanded;                    ///< drawn as the way of the next two seconds.
  double set_distance_m = 0.0;             ///< 0: not drawn.
};

/// The simulated home from above: world x points up, y to the left, as the robot looks at the start. Not for the frame
/// path.
class PlanView {
 public:
  /// \param height_px  of the picture, even; its width follows from the plan.
  PlanView(const hal::Plan& plan, int height_px);

  [[nodiscard]] cv::Size picture_size() const { return ground_.size(); }

  /// \return the picture, B G R; valid until the next call.
  const cv::Mat& draw(const PlanFacts& facts);

 private:
  [[nodiscard]] cv::Point at(double x_m, double y_m) const;
  void draw_ground(const hal::Plan& plan);
  void draw_view(const hal::FloorPose& robot);
  void draw_trails();
  void draw_robot(const PlanFacts& facts);
  void draw_belief(const hal::FloorPose& believed);
  void draw_object(const PlanFacts& facts);

  double x_max_m_;
  double y_max_m_;
  double px_per_m_;
  double view_angle_rad_;
  cv::Mat ground_;
  cv::Mat picture_;
  cv::Mat tint_;
  std::deque<cv::Point> robot_trail_;
  std::deque<cv::Point> object_trail_;
};

}  // namespace cgsr::app
