#include "pipeline/world/occupancy.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace cgsr::world {
namespace {

constexpr int kSub =
    4;  ///< pixels along a cell's side: outlines run through pixels' centres, an eighth of a cell inside of the border.

using Outline = std::vector<cv::Point>;

/// The occupied cells with a free cell around the whole grid; 255: occupied.
cv::Mat padded(const OccupancyGrid& grid) {
  cv::Mat cells = cv::Mat::zeros(grid.rows + 2, grid.columns + 2, CV_8U);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns);
      if (grid.occupied[at + static_cast<std::size_t>(column)] != 0) cells.at<std::uint8_t>(row + 1, column + 1) = 255;
    }
  }
  return cells;
}

/// From pixels of the enlarged, padded image to cells, counted from the image's top left corner.
Eigen::Vector2d cell_at(const cv::Point& pixel) {
  return Eigen::Vector2d((pixel.x + 0.5) / kSub - 1.0, (pixel.y + 0.5) / kSub - 1.0);
}

Eigen::Vector2d in_world(const OccupancyGrid& grid, const Eigen::Vector2d& cell) {
  const Eigen::Vector2d p_OP = grid.cell_m * Eigen::Vector2d(cell.x(), grid.rows - cell.y());
  const double c = std::cos(grid.yaw_rad);
  const double s = std::sin(grid.yaw_rad);
  return grid.p_WO + Eigen::Vector2d(c * p_OP.x() - s * p_OP.y(), s * p_OP.x() + c * p_OP.y());
}

/// The corners of each outline's polygon, in cells.
std::vector<std::vector<Eigen::Vector2d>> polygons_of(const cv::Mat& cells, double cell_m,
                                                      const WallParameters& parameters) {
  cv::Mat enlarged;
  cv::resize(cells, enlarged, {}, kSub, kSub, cv::INTER_NEAREST);
  std::vector<Outline> outlines;
  cv::findContours(enlarged, outlines, cv::RETR_CCOMP, cv::CHAIN_APPROX_SIMPLE);
  const double pixel_m = cell_m / kSub;
  std::vector<std::vector<Eigen::Vector2d>> polygons;
  for (const Outline& outline : outlines) {
    // Once along a thin group is half of the way around it.
    if (cv::arcLength(outline, true) * pixel_m / 2.0 < parameters.min_length_m) continue;
    Outline corners;
    cv::approxPolyDP(outline, corners, parameters.tolerance_m / pixel_m, true);
    if (corners.size() < 2) continue;
    std::vector<Eigen::Vector2d> polygon;
    std::ranges::transform(corners, std::back_inserter(polygon), cell_at);
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

/// The distance of each cell from what is not zero, in cells.
cv::Mat distance_from(const cv::Mat& marked) {
  cv::Mat distance;
  cv::distanceTransform(marked == 0, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance;
}

/// Compares walls and cells both ways.
void compare(const cv::Mat& cells, const std::vector<std::vector<Eigen::Vector2d>>& polygons, double max_cells,
             WallPlan& plan) {
  constexpr int kFraction = 8;  // bits of a corner's coordinates
  cv::Mat drawn = cv::Mat::zeros(cells.size(), CV_8U);
  const auto pixel = [](const Eigen::Vector2d& cell) {
    const auto fixed = [](double x) {
      return static_cast<int>(std::lround((x + 0.5) * (1 << kFraction)));
    };  // padding 1, centre 0.5
    return cv::Point(fixed(cell.x()), fixed(cell.y()));
  };
  for (const auto& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i)
      cv::line(drawn, pixel(polygon[i]), pixel(polygon[(i + 1) % polygon.size()]), 255, 1, cv::LINE_8, kFraction);
  }
  cv::Mat inside;
  cv::erode(cells, inside, cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}));
  const cv::Mat border = cells & ~inside;
  const auto share_near = [&](const cv::Mat& of, const cv::Mat& distance) {
    const cv::Mat near = of & (distance <= max_cells);
    return static_cast<double>(cv::countNonZero(near)) / std::max(1, cv::countNonZero(of));
  };
  plan.border_cells = static_cast<std::size_t>(cv::countNonZero(border));
  plan.covered = share_near(border, distance_from(drawn));
  plan.supported = share_near(drawn, distance_from(cells));
}

}  // namespace

Result<WallPlan> walls_of(const OccupancyGrid& grid, const WallParameters& parameters) {
  const cv::Mat cells = padded(grid);
  const auto polygons = polygons_of(cells, grid.cell_m, parameters);
  WallPlan plan;
  for (const auto& polygon : polygons) {
    const std::size_t walls = polygon.size() == 2 ? 1 : polygon.size();
    for (std::size_t i = 0; i < walls; ++i) {
      plan.walls.push_back({in_world(grid, polygon[i]), in_world(grid, polygon[(i + 1) % polygon.size()])});
      plan.length_m += (plan.walls.back().p_WA - plan.walls.back().p_WB).norm();
    }
  }
  if (plan.walls.empty()) {
    return fail(fmt::format("no wall: {} of {} x {} cells are occupied, none of them in a group of {} m or more",
                            cv::countNonZero(cells), grid.columns, grid.rows, parameters.min_length_m));
  }
  compare(cells, polygons, parameters.tolerance_m / grid.cell_m + 1.0, plan);
  return plan;
}

Soup soup_of(const WallPlan& plan, double height_m) {
  Soup soup;
  soup.materials.push_back({"wall", Eigen::Vector3f::Constant(0.5F), false});
  const auto top = static_cast<float>(height_m);
  for (const Wall& wall : plan.walls) {
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    const Eigen::Vector2f a = wall.p_WA.cast<float>();
    const Eigen::Vector2f b = wall.p_WB.cast<float>();
    soup.points.insert(soup.points.end(),
                       {{a.x(), a.y(), 0.0F}, {b.x(), b.y(), 0.0F}, {b.x(), b.y(), top}, {a.x(), a.y(), top}});
    soup.faces.push_back({static_cast<std::uint32_t>(soup.corners.size()), 4, 0});
    for (std::uint32_t i = 0; i < 4; ++i) soup.corners.push_back(first + i);
  }
  return soup;
}

}  // namespace cgsr::world
