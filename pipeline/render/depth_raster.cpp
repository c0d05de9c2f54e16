#include "pipeline/render/depth_raster.h"

#include <algorithm>
#include <cmath>

namespace cgsr::render {
namespace {

using Sphere = SphereGroups::Sphere;

std::vector<Sphere> spheres_of_edges(const world::Map& map) {
  std::vector<Sphere> spheres;
  spheres.reserve(map.edges.size());
  for (const world::Edge& edge : map.edges) {
    const Eigen::Vector3f& a = map.vertices[edge.vertices[0]];
    const Eigen::Vector3f& b = map.vertices[edge.vertices[1]];
    spheres.push_back({0.5F * (a + b), 0.5F * (b - a).norm()});
  }
  return spheres;
}

// Whatever of the view has at least this inverse depth lies within a distance.
float min_w_within(float distance_m, const View& view) {
  const double x = std::max(view.cx + 0.5, view.width - 0.5 - view.cx) / view.fx;
  const double y = std::max(view.cy + 0.5, view.height - 0.5 - view.cy) / view.fy;
  return static_cast<float>(std::sqrt(1.0 + x * x + y * y)) / std::max(distance_m, 1e-6F);
}

}  // namespace

DepthRaster::DepthRaster(const world::Map& map, const RasterParameters& parameters)
    : map_(map),
      parameters_(parameters),
      views_(parameters.width, parameters.height),
      view_(&views_.of(geometry::Camera())),
      surfaces_(map, parameters),
      edges_(spheres_of_edges(map), {.max_visited = parameters.max_visited, .max_chosen = parameters.max_edges},
             Preference::kLargest),
      buffer_(parameters.width, parameters.height) {
  // An edge that is crossed by many things falls into many pieces, but few do.
  found_.reserve(2 * std::min(map.edges.size(), static_cast<std::size_t>(parameters.max_edges)) + 64);
  lengths_.reserve(found_.capacity());
}

void DepthRaster::look(const geometry::Pose& X_WC, const geometry::Camera& camera, std::vector<VisiblePiece>& pieces) {
  pieces.clear();
  if (pieces.capacity() == 0) pieces.reserve(static_cast<std::size_t>(parameters_.max_pieces));
  draw(X_WC, camera);
  found_.clear();
  // Spheres are told by their radius over their distance.
  const double min_edge = 0.5 * parameters_.min_piece_px / std::max(camera.fx_px, camera.fy_px);
  // Further away than every surface was drawn, nobody knows what is hidden.
  min_w_ = min_w_within(surfaces_.reach_m(), *view_);
  for (const std::uint32_t edge : edges_.select(surfaces_.frustum(), min_edge, surfaces_.reach_m())) look_at_edge(edge);
  keep_longest(std::min(pieces.capacity(), static_cast<std::size_t>(parameters_.max_pieces)));
  const auto earlier = [](const VisiblePiece& a, const VisiblePiece& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.from < b.from;
  };
  if (!std::is_sorted(found_.begin(), found_.end(), earlier)) std::sort(found_.begin(), found_.end(), earlier);
  pieces.insert(pieces.end(), found_.begin(), found_.end());
}

void DepthRaster::draw(const geometry::Pose& X_WC, const geometry::Camera& camera) {
  view_ = &views_.of(camera);
  const Eigen::Vector2d scale(view_->fx / camera.fx_px, view_->fy / camera.fy_px);
  cells_per_px_ = scale.cast<float>();
  first_cell_ =
      Eigen::Vector2d(view_->cx - scale.x() * camera.cx_px, view_->cy - scale.y() * camera.cy_px).cast<float>();
  surfaces_.draw(X_WC, *view_, buffer_);
}

bool DepthRaster::covers(const Eigen::Vector2f& pixel) const {
  const Eigen::Vector2f cell = first_cell_ + cells_per_px_.cwiseProduct(pixel);
  const int x = std::clamp(static_cast<int>(std::lround(cell.x())), 0, buffer_.width() - 1);
  const int y = std::clamp(static_cast<int>(std::lround(cell.y())), 0, buffer_.height() - 1);
  return buffer_.name(x, y) != DepthBuffer::kNothing;
}

void DepthRaster::look_at_edge(std::uint32_t name) {
  const world::Edge& edge = map_.edges[name];
  if (!is_seen_from(map_, edge, surfaces_.p_WC())) return;
  Line line;
  const auto near = static_cast<float>(parameters_.near_m);
  if (!line.set(surfaces_.corner(edge.vertices[0]), surfaces_.corner(edge.vertices[1]), *view_, near, min_w_)) return;
  line.own = edge.surfaces;
  // An edge may lie behind by the tolerance: held a hair nearer, it need not be asked about at each sample.
  line.nearer = 1.0F / (1.0F - static_cast<float>(parameters_.tolerance));
  const float length = line.along.norm();
  if (length < 1e-3F) return;

  const auto cells = static_cast<float>(parameters_.sample_cells);
  const int samples = std::max(1, static_cast<int>(length / cells + 0.999F));
  const float spacing = 1.0F / static_cast<float>(samples);
  const float precision = std::min(static_cast<float>(parameters_.refine_cells) / length, 0.5F * spacing);

  const auto keep = [&](float begin, float end) {
    const VisiblePiece piece = line.piece(name, begin, end, *view_);
    const float long_px = (piece.p1 - piece.p0).norm();
    if (long_px < static_cast<float>(parameters_.min_piece_px) || found_.size() == found_.capacity()) return;
    if (piece.from < piece.to) found_.push_back(piece);
  };
  const float end_slack = 1.0F / length;  // a cell: at a corner, the cell below may belong to a third surface
  bool was = false;
  float begin = 0.0F;
  float before = 0.0F;
  for (int i = 0; i < samples; ++i) {
    const float s = (static_cast<float>(i) + 0.5F) * spacing;
    const bool is = visible(line, s);
    if (is && !was) {
      if (i > 0 || !visible(line, 0.0F)) {
        begin = last_visible(line, s, before, precision);
        if (begin <= end_slack) begin = 0.0F;
      } else {
        begin = 0.0F;
      }
    } else if (!is && was) {
      keep(begin, last_visible(line, before, s, precision));
    }
    was = is;
    before = s;
  }
  if (was) {
    float end = 1.0F;
    if (!visible(line, 1.0F)) {
      end = last_visible(line, before, 1.0F, precision);
      if (end >= 1.0F - end_slack) end = 1.0F;
    }
    keep(begin, end);
  }
}

bool DepthRaster::visible(const Line& line, float s) const {
  const float u = line.from.x() + s * line.along.x();
  const float v = line.from.y() + s * line.along.y();
  const float w = (line.w0 + s * line.dw) * line.nearer;
  const int x = std::clamp(static_cast<int>(u), 0, view_->width - 2);
  const int y = std::clamp(static_cast<int>(v), 0, view_->height - 2);
  const auto around = buffer_.names(x, y);
  const auto behind = [&](std::uint32_t triangle) {
    if (triangle == DepthBuffer::kNothing) return false;
    const std::uint32_t surface = surfaces_.surface_of(triangle);
    return surface != line.own[0] && surface != line.own[1] && w < surfaces_.plane_of(surface).at(u, v);
  };
  if (((around[0] ^ around[1]) | (around[0] ^ around[2]) | (around[0] ^ around[3])) == 0) return !behind(around[0]);
  int hiding = 0;
  for (const std::uint32_t triangle : around) {
    if (!behind(triangle)) continue;
    if (surfaces_.covers(triangle, u, v)) return false;
    ++hiding;
  }
  return hiding < 4;
}

float DepthRaster::last_visible(const Line& line, float seen, float hidden, float precision) const {
  while (std::abs(hidden - seen) > precision) {
    const float middle = 0.5F * (seen + hidden);
    (visible(line, middle) ? seen : hidden) = middle;
  }
  return 0.5F * (seen + hidden);
}

void DepthRaster::keep_longest(std::size_t capacity) {
  if (found_.size() <= capacity) return;
  lengths_.clear();
  for (const VisiblePiece& piece : found_) lengths_.push_back((piece.p1 - piece.p0).squaredNorm());
  const auto cut_at = lengths_.begin() + static_cast<std::ptrdiff_t>(found_.size() - capacity);
  std::nth_element(lengths_.begin(), cut_at, lengths_.end());
  const float least = *cut_at;
  std::erase_if(found_, [&](const VisiblePiece& piece) { return (piece.p1 - piece.p0).squaredNorm() < least; });
  if (found_.size() > capacity) found_.resize(capacity);  // equally long ones
}

}  // namespace cgsr::render
