#include "pipeline/render/osmesa_expectation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <fmt/format.h>

namespace cgsr::render {
namespace {

/// Colours are names counted from 1; 0 is the background.
std::uint32_t color_of(std::uint32_t edge) {
  return edge + 1;
}

}  // namespace

Result<std::unique_ptr<OsmesaExpectation>> OsmesaExpectation::make(const world::Map& map,
                                                                   const OsmesaParameters& parameters) {
  if (map.edges.size() >= world::kNone - 1) {
    return fail(fmt::format("OpenGL: a map of {} edges has more than there are colours", map.edges.size()));
  }
  auto context = OsmesaContext::make(parameters.width, parameters.height);
  if (context == nullptr) {
    return fail(fmt::format("OpenGL: OSMesa gives no context of {} x {} pixels with 24 bits of depth and 8 of stencil",
                            parameters.width, parameters.height));
  }
  std::unique_ptr<OsmesaExpectation> made(new OsmesaExpectation(map, parameters, std::move(context)));
  made->upload();
  std::vector<VisiblePiece> pieces;
  for (int i = 0; i < 2; ++i) made->look(geometry::Pose::Identity(), geometry::Camera(), pieces);
  made->context_->release();
  return made;
}

OsmesaExpectation::OsmesaExpectation(const world::Map& map, const OsmesaParameters& parameters,
                                     std::unique_ptr<OsmesaContext> context)
    : map_(map),
      parameters_(parameters),
      context_(std::move(context)),
      views_(parameters.width, parameters.height),
      view_(&views_.of(geometry::Camera())),
      line_(map.edges.size()) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : map.vertices) box.extend(p);
  if (!box.isEmpty()) {
    middle_ = box.center();
    radius_ = 0.5F * box.diagonal().norm();
  }
  found_.reserve(2 * map.edges.size() + 64);
}

OsmesaExpectation::~OsmesaExpectation() {
  if (!context_->make_current()) return;
  for (const std::uint32_t* buffer : {&vertices_, &lines_, &colors_}) glDeleteBuffers(1, buffer);
}

void OsmesaExpectation::upload() {
  const auto give = [](GLenum kind, std::uint32_t& name, const void* data, std::size_t bytes) {
    glGenBuffers(1, &name);
    glBindBuffer(kind, name);
    glBufferData(kind, static_cast<GLsizeiptr>(bytes), data, GL_STATIC_DRAW);
  };
  give(GL_ARRAY_BUFFER, vertices_, map_.vertices.data(), map_.vertices.size() * sizeof(Eigen::Vector3f));
  std::vector<Eigen::Vector3f> ends;
  std::vector<std::uint32_t> colors;
  ends.reserve(2 * map_.edges.size());
  colors.reserve(2 * map_.edges.size());
  for (std::uint32_t edge = 0; edge < map_.edges.size(); ++edge) {
    for (const std::uint32_t vertex : map_.edges[edge].vertices) {
      ends.push_back(map_.vertices[vertex]);
      colors.push_back(color_of(edge));
    }
  }
  give(GL_ARRAY_BUFFER, lines_, ends.data(), ends.size() * sizeof(Eigen::Vector3f));
  give(GL_ARRAY_BUFFER, colors_, colors.data(), colors.size() * sizeof(std::uint32_t));

  glViewport(0, 0, parameters_.width, parameters_.height);
  glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
  glDisable(GL_DITHER);
  glDisable(GL_BLEND);
  glDisable(GL_LIGHTING);
  glDisable(GL_CULL_FACE);
  glDisable(GL_LINE_SMOOTH);
  glShadeModel(GL_FLAT);
  glLineWidth(1.0F);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glPolygonOffset(0.6F, 1.0F);
  glEnableClientState(GL_VERTEX_ARRAY);
}

void OsmesaExpectation::draw(const geometry::Pose& X_WC) {
  const View& view = *view_;
  const double near = parameters_.near_m;
  const double reach = (X_WC.translation() - middle_.cast<double>()).norm() + static_cast<double>(radius_);
  const double far = std::max(1.01 * reach, 10.0 * near);
  depth_far_ = static_cast<float>(far / (far - near));
  depth_per_w_ = static_cast<float>(-far * near / (far - near));
  // Cells u = fx X/Z + cx to x = 2 (u + 0.5) / width - 1 in OpenGL's clip space, whose w is Z; its y points up, its picture is stored downwards.
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = 2.0 * view.fx / view.width;
  projection(0, 2) = 2.0 * (view.cx + 0.5) / view.width - 1.0;
  projection(1, 1) = -2.0 * view.fy / view.height;
  projection(1, 2) = 1.0 - 2.0 * (view.cy + 0.5) / view.height;
  projection(2, 2) = (far + near) / (far - near);
  projection(2, 3) = -2.0 * far * near / (far - near);
  projection(3, 2) = 1.0;
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixd(projection.data());
  glMatrixMode(GL_MODELVIEW);
  const Eigen::Matrix4d from_world = X_WC.inverse().matrix();
  glLoadMatrixd(from_world.data());

  glClear(static_cast<GLbitfield>(GL_COLOR_BUFFER_BIT) | static_cast<GLbitfield>(GL_DEPTH_BUFFER_BIT));
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glDisableClientState(GL_COLOR_ARRAY);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  glVertexPointer(3, GL_FLOAT, 0, nullptr);
  draw_surfaces(X_WC.translation().cast<float>());

  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDepthMask(GL_FALSE);  // edges do not hide each other
  glEnableClientState(GL_COLOR_ARRAY);
  glBindBuffer(GL_ARRAY_BUFFER, lines_);
  glVertexPointer(3, GL_FLOAT, 0, nullptr);
  glBindBuffer(GL_ARRAY_BUFFER, colors_);
  glColorPointer(4, GL_UNSIGNED_BYTE, 0, nullptr);
  glDrawArrays(GL_LINES, 0, static_cast<GLsizei>(2 * map_.edges.size()));
  glDepthMask(GL_TRUE);
  glFinish();
  depths_ = context_->depths();
}

/// Runs of triangles whose surfaces are seen: all at once where none is one-sided.
void OsmesaExpectation::draw_surfaces(const Eigen::Vector3f& p_WC) const {
  std::size_t first = 0;
  std::size_t end = 0;
  const auto draw_run = [&] {
    if (first == end) return;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * (end - first)), GL_UNSIGNED_INT,
                   map_.triangles.data() + first);
  };
  for (const world::Surface& surface : map_.surfaces) {
    if (!is_seen_from(surface, p_WC)) {
      draw_run();
      first = end = surface.first_triangle + surface.triangle_count;
    } else {
      end = surface.first_triangle + surface.triangle_count;
    }
  }
  draw_run();
}

void OsmesaExpectation::look(const geometry::Pose& X_WC, const geometry::Camera& camera,
                             std::vector<VisiblePiece>& pieces) {
  pieces.clear();
  if (pieces.capacity() == 0) pieces.reserve(found_.capacity());
  if (!context_->make_current()) return;
  view_ = &views_.of(camera);
  draw(X_WC);

  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K << view_->fx, 0.0, view_->cx, 0.0, view_->fy, view_->cy, 0.0, 0.0, 1.0;
  const Eigen::Matrix3f to_cells = (K * X_WC.linear().transpose()).cast<float>();
  const Eigen::Vector3f p_WC = X_WC.translation().cast<float>();
  const auto near = static_cast<float>(parameters_.near_m);
  for (std::uint32_t edge = 0; edge < map_.edges.size(); ++edge) {
    ViewedCorner a;
    ViewedCorner b;
    a.set(to_cells * (map_.vertices[map_.edges[edge].vertices[0]] - p_WC), near);
    b.set(to_cells * (map_.vertices[map_.edges[edge].vertices[1]] - p_WC), near);
    const bool may_be_seen = is_seen_from(map_, map_.edges[edge], p_WC);
    if (!line_[edge].set(a, b, *view_, near) || !may_be_seen) line_[edge].along.setZero();
  }
  found_.clear();
  for (std::uint32_t edge = 0; edge < map_.edges.size(); ++edge) find_pieces(edge, found_);
  if (found_.size() > pieces.capacity()) {
    std::stable_sort(found_.begin(), found_.end(), [](const VisiblePiece& a, const VisiblePiece& b) {
      return (a.p1 - a.p0).squaredNorm() > (b.p1 - b.p0).squaredNorm();
    });
    found_.resize(pieces.capacity());
    std::sort(found_.begin(), found_.end(), [](const VisiblePiece& a, const VisiblePiece& b) {
      return a.edge != b.edge ? a.edge < b.edge : a.from < b.from;
    });
  }
  pieces.insert(pieces.end(), found_.begin(), found_.end());
}

/// Walks along the line as OpenGL did, a pixel of its longer axis a step.
void OsmesaExpectation::find_pieces(std::uint32_t edge, std::vector<VisiblePiece>& pieces) const {
  const EdgeLine& line = line_[edge];
  const float long_axis = line.along.cwiseAbs().maxCoeff();
  if (long_axis < 1e-3F) return;
  const int steps = std::max(1, static_cast<int>(std::lround(long_axis)));
  const float step = 1.0F / static_cast<float>(steps);
  const auto gap = static_cast<int>(parameters_.min_gap_px * view_->cells_per_px_x());
  const auto keep = [&](int first, int last) {
    const VisiblePiece piece =
        line.piece(edge, static_cast<float>(first) * step, static_cast<float>(last) * step, *view_);
    const float length_px = (piece.p1 - piece.p0).norm();
    if (length_px >= static_cast<float>(parameters_.min_piece_px) && piece.from < piece.to) pieces.push_back(piece);
  };
  int first = -1;
  int last = -1;  // one beyond the last that was shown
  for (int i = 0; i < steps; ++i) {
    if (!shown(edge, (static_cast<float>(i) + 0.5F) * step)) continue;
    if (first >= 0 && i - last > gap) {
      keep(first, last);
      first = -1;
    }
    if (first < 0) first = i;
    last = i + 1;
  }
  if (first >= 0) keep(first, last);
}

/// Whether the edge shows there: a pixel of its own colour, or one of an edge that was drawn over it, where its own depth would have passed.
bool OsmesaExpectation::shown(std::uint32_t edge, float s) const {
  const EdgeLine& line = line_[edge];
  const Eigen::Vector2f at = line.from + s * line.along;
  const bool flat = std::abs(line.along.x()) >= std::abs(line.along.y());
  const auto pixels = context_->pixels();
  for (const int beside : {0, -1, 1}) {
    const auto x = static_cast<int>(std::lround(at.x())) + (flat ? 0 : beside);
    const auto y = static_cast<int>(std::lround(at.y())) + (flat ? beside : 0);
    if (x < 0 || y < 0 || x >= view_->width || y >= view_->height) continue;
    const std::uint32_t color = pixels[static_cast<std::size_t>(y * view_->width + x)];
    if (color == color_of(edge)) return true;
    if (beside != 0 || color == 0 || depths_.empty()) continue;
    const std::uint32_t there = depths_[static_cast<std::size_t>((view_->height - 1 - y) * view_->width + x)];
    const float depth = depth_far_ + depth_per_w_ * (line.w0 + s * line.dw);
    if (depth <= static_cast<float>(there & 0xFFFFFFU) / 16777215.0F) return true;
  }
  return false;
}

}  // namespace cgsr::render
