#include "src/output/plan_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

namespace cgsr::app {
namespace {

constexpr int kMargin_px = 4;
constexpr int kShift = 4;  // points are drawn with sixteenths of a pixel
constexpr double kSight_m = 5.0;
constexpr std::size_t kTrail = 1500;
const cv::Scalar kRobot(40, 40, 230);
const cv::Scalar kObject(60, 200, 60);
const cv::Scalar kBelief(230, 160, 40);
const cv::Scalar kDark(30, 30, 30);
const cv::Scalar kViewTint(120, 235, 255);

double scale_of(const hal::Plan& plan, int height_px) {
  return (height_px - 2 * kMargin_px) / std::max(0.1, plan.max_x_m - plan.min_x_m);
}

}  // namespace

PlanView::PlanView(const hal::Plan& plan, int height_px)
    : x_max_m_(plan.max_x_m),
      y_max_m_(plan.max_y_m),
      px_per_m_(scale_of(plan, height_px)),
      view_angle_rad_(plan.view_angle_rad) {
  const int width_px = 2 * kMargin_px + static_cast<int>(std::ceil((plan.max_y_m - plan.min_y_m) * px_per_m_));
  ground_.create(height_px, (width_px + 1) & ~1, CV_8UC3);
  draw_ground(plan);
}

cv::Point PlanView::at(double x_m, double y_m) const {
  return {cvRound((kMargin_px + (y_max_m_ - y_m) * px_per_m_) * (1 << kShift)),
          cvRound((kMargin_px + (x_max_m_ - x_m) * px_per_m_) * (1 << kShift))};
}

void PlanView::draw_ground(const hal::Plan& plan) {
  ground_.setTo(kDark);
  for (const hal::PlanPiece& piece : plan.pieces) {
    std::array<cv::Point, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = at(static_cast<double>(piece.corners_m[i][0]), static_cast<double>(piece.corners_m[i][1]));
    }
    const cv::Scalar color(255.0 * piece.srgb[2], 255.0 * piece.srgb[1], 255.0 * piece.srgb[0]);
    cv::fillConvexPoly(ground_, corners.data(), 3, color, cv::LINE_8, kShift);
  }
}

const cv::Mat& PlanView::draw(const PlanFacts& facts) {
  ground_.copyTo(picture_);
  draw_view(facts.truth.robot);
  robot_trail_.push_back(at(facts.truth.robot.x_m, facts.truth.robot.y_m));
  if (facts.truth.there) object_trail_.push_back(at(facts.truth.object.x_m, facts.truth.object.y_m));
  for (auto* trail : {&robot_trail_, &object_trail_}) {
    if (trail->size() > kTrail) trail->pop_front();
  }
  draw_trails();
  draw_object(facts);
  draw_robot(facts);
  if (facts.believed) draw_belief(*facts.believed);
  const std::string text =
      fmt::format("{:+.2f} m/s  {:+.2f} rad/s", facts.commanded.forward_mps, facts.commanded.left_radps);
  cv::putText(picture_, text, {kMargin_px + 6, picture_.rows - 10}, cv::FONT_HERSHEY_SIMPLEX, 0.43, {255, 255, 255}, 1,
              cv::LINE_AA);
  return picture_;
}

void PlanView::draw_view(const hal::FloorPose& robot) {
  std::vector<cv::Point> fan{at(robot.x_m, robot.y_m)};
  for (int i = -8; i <= 8; ++i) {
    const double angle = robot.heading_rad + view_angle_rad_ * i / 16.0;
    fan.push_back(at(robot.x_m + kSight_m * std::cos(angle), robot.y_m + kSight_m * std::sin(angle)));
  }
  picture_.copyTo(tint_);
  cv::fillConvexPoly(tint_, fan, kViewTint, cv::LINE_AA, kShift);
  cv::addWeighted(tint_, 0.25, picture_, 0.75, 0.0, picture_);
}

void PlanView::draw_trails() {
  for (const auto& [trail, color] : {std::pair{&robot_trail_, kRobot}, std::pair{&object_trail_, kObject}}) {
    for (std::size_t i = 1; i < trail->size(); ++i) {
      cv::line(picture_, (*trail)[i - 1], (*trail)[i], color, 1, cv::LINE_AA, kShift);
    }
  }
}

void PlanView::draw_object(const PlanFacts& facts) {
  if (!facts.truth.there) return;
  const cv::Point center = at(facts.truth.object.x_m, facts.truth.object.y_m);
  const int radius = cvRound(0.16 * px_per_m_ * (1 << kShift));
  cv::circle(picture_, center, radius, kObject, facts.found ? cv::FILLED : 2, cv::LINE_AA, kShift);
  cv::circle(picture_, center, radius, kDark, 1, cv::LINE_AA, kShift);
  if (facts.set_distance_m > 0.0) {
    cv::circle(picture_, center, cvRound(facts.set_distance_m * px_per_m_ * (1 << kShift)), kObject, 1, cv::LINE_AA,
               kShift);
  }
}

void PlanView::draw_belief(const hal::FloorPose& believed) {
  const cv::Point center = at(believed.x_m, believed.y_m);
  const int radius = cvRound(0.25 * px_per_m_ * (1 << kShift));
  cv::circle(picture_, center, radius, kBelief, 2, cv::LINE_AA, kShift);
  cv::line(picture_, center,
           at(believed.x_m + 0.4 * std::cos(believed.heading_rad), believed.y_m + 0.4 * std::sin(believed.heading_rad)),
           kBelief, 2, cv::LINE_AA, kShift);
}

void PlanView::draw_robot(const PlanFacts& facts) {
  const hal::FloorPose& robot = facts.truth.robot;
  const cv::Point center = at(robot.x_m, robot.y_m);
  const int radius = cvRound(0.25 * px_per_m_ * (1 << kShift));
  cv::circle(picture_, center, radius, kRobot, cv::FILLED, cv::LINE_AA, kShift);
  cv::circle(picture_, center, radius, kDark, 1, cv::LINE_AA, kShift);
  const auto ahead = [&](double way_m, double turn_rad) {
    return at(robot.x_m + way_m * std::cos(robot.heading_rad + turn_rad),
              robot.y_m + way_m * std::sin(robot.heading_rad + turn_rad));
  };
  cv::line(picture_, center, ahead(0.25, 0.0), {255, 255, 255}, 2, cv::LINE_AA, kShift);
  cv::Point from = center;
  for (int i = 1; i <= 10; ++i) {  // where the command leads within two seconds
    const double time_s = 0.2 * i;
    const cv::Point to = ahead(facts.commanded.forward_mps * time_s, 0.5 * facts.commanded.left_radps * time_s);
    cv::line(picture_, from, to, {0, 255, 255}, 2, cv::LINE_AA, kShift);
    from = to;
  }
}

}  // namespace cgsr::app
