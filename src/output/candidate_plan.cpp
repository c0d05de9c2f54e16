#include "src/output/candidate_plan.h"

#include <algorithm>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace cgsr::app {
namespace {

constexpr double kLongerSide_px = 900.0;
constexpr double kMargin_m = 0.5;
constexpr double kArrow_m = 0.7;
const cv::Scalar kGround(250, 250, 248);
const cv::Scalar kEdge(150, 140, 130);
const cv::Scalar kRight(60, 150, 30);
const cv::Scalar kVain(30, 130, 240);
const cv::Scalar kNotTried(120, 120, 120);

}  // namespace

cv::Mat draw_candidates(const world::Map& map, std::span<const global_localization::Candidate> candidates) {
  Eigen::Vector2f least = map.vertices.front().head<2>();
  Eigen::Vector2f most = least;
  for (const Eigen::Vector3f& vertex : map.vertices) {
    least = least.cwiseMin(vertex.head<2>());
    most = most.cwiseMax(vertex.head<2>());
  }
  const Eigen::Vector2d size = (most - least).cast<double>() + Eigen::Vector2d::Constant(2.0 * kMargin_m);
  const double px_per_m = kLongerSide_px / size.maxCoeff();
  cv::Mat picture(static_cast<int>(size.y() * px_per_m), static_cast<int>(size.x() * px_per_m), CV_8UC3, kGround);
  const auto at = [&](double x_m, double y_m) {
    return cv::Point(
        static_cast<int>((x_m - static_cast<double>(least.x()) + kMargin_m) * px_per_m),
        picture.rows - 1 - static_cast<int>((y_m - static_cast<double>(least.y()) + kMargin_m) * px_per_m));
  };
  const auto at_vertex = [&](std::uint32_t vertex) {
    const Eigen::Vector3f& p = map.vertices[vertex];
    return at(static_cast<double>(p.x()), static_cast<double>(p.y()));
  };
  for (const world::Edge& edge : map.edges)
    cv::line(picture, at_vertex(edge.vertices[0]), at_vertex(edge.vertices[1]), kEdge, 1, cv::LINE_AA);
  const int enough = global_localization::GlobalLocalizerParameters{}.min_corrected;
  for (const global_localization::Candidate& candidate : candidates) {
    const Eigen::Vector3d from = candidate.X_WR.translation();
    const Eigen::Vector3d to = candidate.X_WR * Eigen::Vector3d(kArrow_m, 0.0, 0.0);
    const bool right = candidate.tried && candidate.corrected >= enough;
    const cv::Scalar& color = right ? kRight : candidate.tried ? kVain : kNotTried;
    cv::circle(picture, at(from.x(), from.y()), static_cast<int>(0.2 * px_per_m), color, 2, cv::LINE_AA);
    cv::arrowedLine(picture, at(from.x(), from.y()), at(to.x(), to.y()), color, 2, cv::LINE_AA, 0, 0.25);
    cv::putText(picture, fmt::format("{:.2f}, {}", candidate.likeness, candidate.corrected),
                at(from.x(), from.y()) + cv::Point(12, 22), cv::FONT_HERSHEY_SIMPLEX, 0.5, color, 1, cv::LINE_AA);
  }
  return picture;
}

}  // namespace cgsr::app
