#include "pipeline/global_localization/place_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "pipeline/localization/work.h"

namespace cgsr::global_localization {
namespace {

constexpr double kSide = 2.0 * std::numbers::pi / PlaceIndex::kSides;
constexpr double kFocalPerWidth = 0.277;  // of a camera that sees 122 degrees: a third of the way round, and a little
constexpr int kSideUnits = 4;             // a look to one side: 2 to 4 million instructions
constexpr int kFinishUnits = 1;           // its harmonics: half a million
constexpr std::size_t kMostPieces = 3000;

render::RasterParameters raster_parameters() {
  render::RasterParameters raster;
  raster.width = 160;  // cells of half a degree: six in one of the panorama
  raster.height = 120;
  raster.min_piece_px = 3.0;
  raster.max_surfaces = 1000;
  raster.max_edges = 1200;
  return raster;
}

geometry::Camera wide_camera() {
  geometry::Camera camera;
  camera.width_px = 320;
  camera.height_px = 240;
  camera.fx_px = camera.fy_px = kFocalPerWidth * camera.width_px;
  camera.cx_px = 0.5 * (camera.width_px - 1);
  camera.cy_px = 0.5 * (camera.height_px - 1);
  return camera;
}

constexpr double kApart = 1.2;  // steps of the grid: more than to the next one, less than to the one at a corner

// Places of which none is next to another one, before the others. \return how many.
std::size_t take_apart(std::vector<Eigen::Vector2d>& places_m, double spacing_m) {
  std::vector<Eigen::Vector2d> apart;
  std::vector<Eigen::Vector2d> between;
  for (const Eigen::Vector2d& place : places_m) {
    const bool is_next_to_one = std::ranges::any_of(
        apart, [&](const Eigen::Vector2d& other) { return (other - place).norm() < kApart * spacing_m; });
    (is_next_to_one ? between : apart).push_back(place);
  }
  places_m = apart;
  places_m.insert(places_m.end(), between.begin(), between.end());
  return apart.size();
}

}  // namespace

Sector seen_by(const geometry::Camera& camera, const geometry::Pose& X_RC, double half_width) {
  const auto elevation = [&](double column, double row) {
    const Eigen::Vector3d ray_R = X_RC.linear() * Eigen::Vector3d((column - camera.cx_px) / camera.fx_px,
                                                                  (row - camera.cy_px) / camera.fy_px, 1.0);
    return std::asin(ray_R.normalized().z());
  };
  const double aside = std::tan(half_width) * camera.fx_px;
  const std::array columns{camera.cx_px - aside, camera.cx_px, camera.cx_px + aside};
  const Eigen::Vector3d ahead_R = X_RC.linear().col(2);
  Sector sector{.middle = std::atan2(ahead_R.y(), ahead_R.x()),
                .half_width = half_width,
                .min_elevation = -kSide,
                .max_elevation = kSide};
  for (const double column : columns) {
    sector.max_elevation = std::min(sector.max_elevation, elevation(column, 1.0));
    sector.min_elevation = std::max(sector.min_elevation, elevation(column, camera.height_px - 2.0));
  }
  return sector;
}

PlaceIndex::PlaceIndex(const world::Map& map, const geometry::Camera& camera, const geometry::Pose& X_RC,
                       std::vector<Eigen::Vector2d> places_m, double spacing_m)
    : X_RC_(X_RC),
      wide_(wide_camera()),
      sector_(seen_by(camera, X_RC, std::numbers::pi / kKeyframes)),
      raster_(std::make_unique<render::DepthRaster>(map, raster_parameters())),
      view_(map, kMostPieces),
      places_m_(std::move(places_m)),
      apart_(take_apart(places_m_, spacing_m)),
      panoramas_(places_m_.size()),
      sides_(places_m_.size(), 0) {
  visible_.reserve(kMostPieces);
  sector_.half_width = 0.5 * kSide;
}

void PlaceIndex::look(std::size_t place, int side) {
  const Eigen::Vector2d& at = places_m_[place];
  Sector sector = sector_;
  sector.middle += side * kSide;
  const geometry::Pose X_WC = geometry::pose_on_floor(at.x(), at.y(), side * kSide) * X_RC_;
  raster_->look(X_WC, wide_, visible_);
  view_.take(visible_, X_WC);
  view_.project(X_WC, wide_);
  for (const localization::ProjectedPiece& piece : view_.projected()) {
    panoramas_[place].add(view_.point_at(piece, -piece.half_length) - X_WC.translation(),
                          view_.point_at(piece, piece.half_length) - X_WC.translation(),
                          static_cast<double>(piece.weight), sector);
  }
}

bool PlaceIndex::build(std::size_t place, WorkBudget& budget) {
  for (int& side = sides_[place]; side < kSides; ++side) {
    const bool is_last = side + 1 == kSides;
    if (!localization::granted(budget, is_last ? kSideUnits + kFinishUnits : kSideUnits)) return false;
    look(place, side);
    if (is_last) panoramas_[place].finish();
  }
  return true;
}

bool PlaceIndex::build(WorkBudget& budget) {
  for (; next_ < places_m_.size(); ++next_) {
    if (!build(next_, budget)) return false;
  }
  return true;
}

}  // namespace cgsr::global_localization
