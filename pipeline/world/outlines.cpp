#include "pipeline/world/outlines.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "pipeline/world/tree.h"

namespace cgsr::world {
namespace {

// Two surfaces that bend by less than this are flat, or folded onto each other.
const double kCosFlat = std::cos(0.6 * 3.14159265358979 / 180.0);
constexpr std::size_t kMaxNear = 500;     // pieces of outlines, on average, whose box a corner may lie in.
constexpr std::size_t kMaxAtVertex = 64;  // edges at one corner that are compared when straight lines are joined again.

/// A piece of a surface's outline, counter-clockwise: the surface lies to the left of from -> to.
struct Piece {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t surface = 0;

  [[nodiscard]] std::uint32_t low() const { return std::min(from, to); }
  [[nodiscard]] std::uint32_t high() const { return std::max(from, to); }
  bool operator<(const Piece& o) const {
    return std::make_tuple(low(), high(), surface, from) < std::make_tuple(o.low(), o.high(), o.surface, o.from);
  }
  [[nodiscard]] bool same_line(const Piece& o) const { return low() == o.low() && high() == o.high(); }
};

class Tracer {
 public:
  Tracer(double weld_m, Map& map) : weld_m_(weld_m), map_(map) {}

  bool run(const std::vector<std::array<std::uint32_t, 2>>& lines,
           const std::vector<std::array<std::uint32_t, 2>>& diagonals) {
    collect();
    if (!diagonals.empty()) leave_out(diagonals);
    if (!cut()) return false;
    pair();
    straighten();
    draw(lines);
    return true;
  }

 private:
  [[nodiscard]] Eigen::Vector3d point(std::uint32_t v) const { return map_.vertices[v].cast<double>(); }

  // Sides of triangles that are no other triangle's of the same surface.
  void collect() {
    std::vector<Piece> all;
    all.reserve(3 * map_.triangles.size());
    for (std::uint32_t s = 0; s < map_.surfaces.size(); ++s) {
      const Surface& surface = map_.surfaces[s];
      for (std::uint32_t t = 0; t < surface.triangle_count; ++t) {
        const Triangle& triangle = map_.triangles[surface.first_triangle + t];
        for (std::size_t i = 0; i < 3; ++i) all.push_back({triangle[i], triangle[(i + 1) % 3], s});
      }
    }
    std::sort(all.begin(), all.end());
    for (std::size_t i = 0; i < all.size();) {
      std::size_t end = i + 1;
      while (end < all.size() && all[end].same_line(all[i]) && all[end].surface == all[i].surface) ++end;
      if (end == i + 1) pieces_.push_back(all[i]);
      i = end;
    }
  }

  // The two halves of a warped face meet there, and nothing else does.
  void leave_out(const std::vector<std::array<std::uint32_t, 2>>& diagonals) {
    std::vector<Piece> left;
    left.reserve(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size();) {
      std::size_t end = i + 1;
      while (end < pieces_.size() && pieces_[end].same_line(pieces_[i])) ++end;
      const std::array<std::uint32_t, 2> line{pieces_[i].low(), pieces_[i].high()};
      if (end != i + 2 || !std::binary_search(diagonals.begin(), diagonals.end(), line)) {
        left.insert(left.end(), pieces_.begin() + static_cast<std::ptrdiff_t>(i),
                    pieces_.begin() + static_cast<std::ptrdiff_t>(end));
      }
      i = end;
    }
    pieces_.swap(left);
  }

  // Where the end of one piece touches the inside of another, that one is cut. \return false: it would take too long.
  bool cut() {
    std::vector<Notch> notches;
    if (!find_notches(notches)) return false;
    if (notches.empty()) return true;
    std::sort(notches.begin(), notches.end());
    std::vector<Piece> result;
    result.reserve(pieces_.size() + notches.size());
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      Piece rest = pieces_[i];
      for (; next < notches.size() && notches[next].piece == i; ++next) {
        if (notches[next].vertex == rest.from) continue;
        result.push_back({rest.from, notches[next].vertex, rest.surface});
        rest.from = notches[next].vertex;
      }
      result.push_back(rest);
    }
    std::sort(result.begin(), result.end());
    pieces_.swap(result);
    return true;
  }

  // A vertex at which a piece is to be cut.
  struct Notch {
    std::uint32_t piece = 0;
    double along_m = 0.0;
    std::uint32_t vertex = 0;
    bool operator<(const Notch& o) const {
      return std::tie(piece, along_m, vertex) < std::tie(o.piece, o.along_m, o.vertex);
    }
  };

  [[nodiscard]] std::vector<std::uint32_t> ends_of_pieces() const {
    std::vector<std::uint32_t> ends;
    ends.reserve(2 * pieces_.size());
    for (const Piece& piece : pieces_) {
      ends.push_back(piece.from);
      ends.push_back(piece.to);
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    return ends;
  }

  bool find_notches(std::vector<Notch>& notches) const {
    std::vector<Bounds> boxes;
    boxes.reserve(pieces_.size());
    for (const Piece& piece : pieces_) {
      Bounds box;
      box.add(map_.vertices[piece.from]);
      box.add(map_.vertices[piece.to]);
      boxes.push_back(box);
    }
    const std::vector<std::uint32_t> ends = ends_of_pieces();
    const Tree tree(boxes, 8);
    // Where everything lies among everything, this would not end in useful time.
    const std::size_t max_compared = kMaxNear * ends.size() + 1'000'000;
    std::size_t compared = 0;
    for (const std::uint32_t v : ends) {
      if (compared > max_compared) return false;
      Bounds box;
      box.low = map_.vertices[v].array() - static_cast<float>(weld_m_);
      box.high = map_.vertices[v].array() + static_cast<float>(weld_m_);
      tree.touching(box, [&](std::uint32_t i) {
        ++compared;
        const Piece& piece = pieces_[i];
        if (piece.from == v || piece.to == v) return;
        const Eigen::Vector3d whole = point(piece.to) - point(piece.from);
        const Eigen::Vector3d part = point(v) - point(piece.from);
        const double length = whole.norm();
        const double along = part.dot(whole) / length;
        if (along <= weld_m_ || along >= length - weld_m_) return;
        if ((part - whole * (along / length)).norm() > weld_m_) return;
        notches.push_back({i, along, v});
      });
    }
    return true;
  }

  // From the line into the surface, in its plane.
  [[nodiscard]] Eigen::Vector3d inwards(const Piece& piece) const {
    const Eigen::Vector3d along = (point(piece.to) - point(piece.from)).normalized();
    return normal(piece).cross(along);
  }

  [[nodiscard]] Eigen::Vector3d normal(const Piece& piece) const {
    return map_.surfaces[piece.surface].normal.cast<double>();
  }

  [[nodiscard]] std::uint32_t material(const Piece& piece) const { return map_.surfaces[piece.surface].material; }

  void add(const Piece& first, std::uint32_t second, EdgeKind kind) {
    Edge edge;
    edge.vertices = {first.from, first.to};
    edge.surfaces = {first.surface, second};
    edge.kind = kind;
    map_.edges.push_back(edge);
  }

  void pair() {
    std::vector<Piece> here;
    for (std::size_t i = 0; i < pieces_.size();) {
      here.clear();
      const std::size_t first = i;
      for (; i < pieces_.size() && pieces_[i].same_line(pieces_[first]); ++i) here.push_back(pieces_[i]);
      meet(here);
    }
  }

  // What is left of the outlines on one line: surfaces that pass by are no edge, but what ends on them is.
  void meet(std::vector<Piece>& here) {
    std::vector<Piece> passing;
    for (std::size_t a = 0; a < here.size(); ++a) {
      for (std::size_t b = a + 1; b < here.size() && b < a + kMaxAtVertex; ++b) {
        const double bend = inwards(here[a]).dot(inwards(here[b]));
        const bool flat = bend < -kCosFlat;
        const bool alike = here[a].surface == here[b].surface || material(here[a]) == material(here[b]);
        if (flat && alike) {
          passing.push_back(here[a]);
          erase(here, b);
          erase(here, a);
          --a;
          break;
        }
        if (bend > kCosFlat) {  // folded onto each other: one of them is visible
          erase(here, b);
          --b;
        }
      }
    }
    if (here.empty()) {
      if (passing.size() >= 2) add(passing[0], passing[1].surface, EdgeKind::kCrease);
      return;
    }
    if (here.size() == 1) {
      if (passing.empty()) {
        add(here[0], kNone, EdgeKind::kBorder);
      } else {
        add(here[0], passing[0].surface, EdgeKind::kCrease);
      }
      return;
    }
    const auto [first, second] = seen_together(here);
    const bool flat = inwards(first).dot(inwards(second)) < -kCosFlat;
    add(first, second.surface, flat ? EdgeKind::kMaterial : EdgeKind::kCrease);
  }

  // Of three and more that meet: two that lie in front of each other (floor and wall, not the wall's bottom), else two that go on flat, else any.
  [[nodiscard]] std::pair<Piece, Piece> seen_together(const std::vector<Piece>& here) const {
    std::pair<Piece, Piece> best{here[0], here[1]};
    double best_score = -1.0;
    for (std::size_t a = 0; a < here.size() && here.size() > 2; ++a) {
      for (std::size_t b = a + 1; b < std::min(here.size(), a + kMaxAtVertex); ++b) {
        const Eigen::Vector3d into_a = inwards(here[a]);
        const Eigen::Vector3d into_b = inwards(here[b]);
        const bool facing = into_a.dot(normal(here[b])) > 0.01 && into_b.dot(normal(here[a])) > 0.01;
        const bool flat = into_a.dot(into_b) < -kCosFlat;
        const double score = facing ? 2.0 + into_a.dot(into_b) : (flat ? 0.5 : 0.0);
        if (score <= best_score) continue;
        best_score = score;
        best = {here[a], here[b]};
      }
    }
    return best;
  }

  static void erase(std::vector<Piece>& pieces, std::size_t i) {
    pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(i));
  }

  // Neighbours in one straight line, between the same surfaces, become one again.
  void straighten() {
    const std::size_t count = map_.edges.size();
    std::vector<std::uint32_t> first(map_.vertices.size() + 1, 0);
    for (const Edge& edge : map_.edges) ++first[edge.vertices[0] + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<std::uint32_t> begin_here(count);
    std::vector<std::uint32_t> fill(first.begin(), first.end() - 1);
    for (std::uint32_t e = 0; e < count; ++e) begin_here[fill[map_.edges[e].vertices[0]]++] = e;

    std::vector<std::uint32_t> next(count, kNone);
    std::vector<bool> follows(count, false);
    for (std::uint32_t e = 0; e < count; ++e) {
      const Edge& edge = map_.edges[e];
      const std::uint32_t v = edge.vertices[1];
      const std::size_t end = std::min<std::size_t>(first[v + 1], first[v] + kMaxAtVertex);
      for (std::size_t i = first[v]; i < end; ++i) {
        const std::uint32_t other = begin_here[i];
        if (other == e || follows[other] || !carries_on(edge, map_.edges[other])) continue;
        next[e] = other;
        follows[other] = true;
        break;
      }
    }
    std::vector<Edge> edges;
    edges.reserve(count);
    const auto walk = [&](std::uint32_t from) {
      Edge whole = map_.edges[from];
      for (std::uint32_t e = next[from]; e != kNone; e = next[e]) {
        next[from] = kNone;
        from = e;
        const std::uint32_t end = map_.edges[e].vertices[1];
        if (in_line(map_.edges[e], whole) && end != whole.vertices[0]) {
          whole.vertices[1] = end;
        } else {
          edges.push_back(whole);
          whole = map_.edges[e];
        }
      }
      edges.push_back(whole);
    };
    for (std::uint32_t e = 0; e < count; ++e) {
      if (!follows[e]) walk(e);
    }
    map_.edges.swap(edges);
  }

  [[nodiscard]] bool carries_on(const Edge& a, const Edge& b) const {
    if (a.surfaces != b.surfaces || a.kind != b.kind || b.vertices[1] == a.vertices[0]) return false;
    const Eigen::Vector3d da = point(a.vertices[1]) - point(a.vertices[0]);
    const Eigen::Vector3d db = point(b.vertices[1]) - point(b.vertices[0]);
    return da.dot(db) > 0.0 && in_line(b, a);
  }

  // Both ends of the piece lie on the line through the whole.
  [[nodiscard]] bool in_line(const Edge& piece, const Edge& whole) const {
    const Eigen::Vector3d a = point(whole.vertices[0]);
    const Eigen::Vector3d chord = point(piece.vertices[1]) - a;
    const Eigen::Vector3d part = point(piece.vertices[0]) - a;
    const double length = chord.norm();
    if (!(length > 0.0)) return false;
    return part.cross(chord).norm() / length <= 2.0 * weld_m_;
  }

  void draw(const std::vector<std::array<std::uint32_t, 2>>& lines) {
    if (lines.empty()) return;
    std::vector<Bounds> boxes;
    boxes.reserve(map_.edges.size());
    for (const Edge& edge : map_.edges) {
      Bounds box;
      for (const std::uint32_t v : edge.vertices) box.add(map_.vertices[v]);
      boxes.push_back(box);
    }
    const Tree tree(boxes, 8);
    std::vector<std::array<std::uint32_t, 2>> drawn;
    for (const auto& line : lines) {
      Edge edge;
      edge.vertices = {std::min(line[0], line[1]), std::max(line[0], line[1])};
      edge.kind = EdgeKind::kDrawn;
      if (line[0] == line[1] || covered(edge, tree)) continue;
      drawn.push_back(edge.vertices);
    }
    std::sort(drawn.begin(), drawn.end());
    drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
    for (const auto& vertices : drawn) {
      Edge edge;
      edge.vertices = vertices;
      edge.kind = EdgeKind::kDrawn;
      map_.edges.push_back(edge);
    }
  }

  [[nodiscard]] bool covered(const Edge& line, const Tree& tree) const {
    Bounds box;
    const Eigen::Array3f middle = (0.5F * (map_.vertices[line.vertices[0]] + map_.vertices[line.vertices[1]])).array();
    box.low = middle - 1e-3F;
    box.high = middle + 1e-3F;
    bool found = false;
    tree.touching(box, [&](std::uint32_t e) { found = found || covers(map_.edges[e], line); });
    return found;
  }

  [[nodiscard]] bool covers(const Edge& edge, const Edge& line) const {
    const Eigen::Vector3d a = point(edge.vertices[0]);
    const Eigen::Vector3d whole = point(edge.vertices[1]) - a;
    const double length = whole.norm();
    for (const std::uint32_t v : line.vertices) {
      const Eigen::Vector3d part = point(v) - a;
      const double along = part.dot(whole) / length;
      const double off = (part - whole * (along / length)).norm();
      if (along < -2.0 * weld_m_ || along > length + 2.0 * weld_m_ || off > 2.0 * weld_m_) return false;
    }
    return true;
  }

  double weld_m_;
  Map& map_;
  std::vector<Piece> pieces_;
};

}  // namespace

bool trace_outlines(const std::vector<std::array<std::uint32_t, 2>>& lines,
                    const std::vector<std::array<std::uint32_t, 2>>& diagonals, double weld_m, Map& map) {
  return Tracer(weld_m, map).run(lines, diagonals);
}

}  // namespace cgsr::world
