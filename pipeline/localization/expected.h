#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "pipeline/geometry/camera.h"
#include "pipeline/geometry/pose.h"
#include "pipeline/render/expectation.h"
#include "pipeline/world/map.h"

namespace cgsr::localization {

/// What is expected beside an edge of the map, worked out once: where its two surfaces lie and which of them is brighter.
struct EdgeSides {
  Eigen::Vector3f inward[2] = {
      Eigen::Vector3f::Zero(),
      Eigen::Vector3f::Zero()};  ///< along the surface, away from the edge; unit; zero: no surface.
  std::int8_t brighter = -1;     ///< index of the surely brighter side; -1: not known.
  float weight = 1.0F;           ///< how sure it is to be perceived, 0..1.
};

/// EdgeSides of every edge of a map.
std::vector<EdgeSides> sides_of(const world::Map& map);

/// A visible piece of an edge in space.
struct ExpectedPiece {
  std::uint32_t edge = 0;
  Eigen::Vector3f p0_W = Eigen::Vector3f::Zero();
  Eigen::Vector3f p1_W = Eigen::Vector3f::Zero();
  bool ends_at_p0 = false;  ///< the edge itself does: nothing in front hides the rest of it.
  bool ends_at_p1 = false;
};

/// ... and in the image of a camera without lens.
struct ProjectedPiece {
  std::uint32_t piece = 0;  ///< index of the ExpectedPiece.
  Eigen::Vector2f middle = Eigen::Vector2f::Zero();
  Eigen::Vector2f direction = Eigen::Vector2f::UnitX();  ///< unit, from p0 to p1.
  float half_length = 0.0F;
  float depth0_m = 0.0F;  ///< of the two ends of what is inside of the image.
  float depth1_m = 0.0F;
  float from = 0.0F;  ///< which part of the piece is inside of the image, in space.
  float to = 1.0F;
  std::int8_t bright_side =
      0;  ///< +1: the brighter side lies along (-y, x) of direction; -1: against it; 0: not known.
  float weight = 1.0F;
};

/// Pieces of edges and what they look like: found once, projected from any pose near by (4.2's expectation between full ones).
class ExpectedView {
 public:
  ExpectedView(const world::Map& map, std::size_t most_pieces);

  /// Takes over what is visible from a pose.
  void take(std::span<const render::VisiblePiece> visible, const geometry::Pose& X_WC);

  /// Projects the pieces that were taken. What is behind the camera, outside of the image or too short is left out.
  void project(const geometry::Pose& X_WC, const geometry::Camera& camera);

  [[nodiscard]] std::span<const ExpectedPiece> pieces() const { return pieces_; }
  [[nodiscard]] std::span<const ProjectedPiece> projected() const { return projected_; }

  /// The point of a projected piece that is seen `along` pixels from its middle.
  [[nodiscard]] Eigen::Vector3d point_at(const ProjectedPiece& piece, float along) const;

  /// Whether the edge itself ends where a projected piece does, neither hidden nor cut off by the image's border.
  [[nodiscard]] bool ends_at_first(const ProjectedPiece& piece) const {
    return piece.from <= 0.0F && pieces_[piece.piece].ends_at_p0;
  }
  [[nodiscard]] bool ends_at_last(const ProjectedPiece& piece) const {
    return piece.to >= 1.0F && pieces_[piece.piece].ends_at_p1;
  }

 private:
  const world::Map* map_;
  std::vector<EdgeSides> sides_;
  std::size_t most_;
  std::vector<ExpectedPiece> pieces_;
  std::vector<ProjectedPiece> projected_;
};

/// Alg. 4.1's prediction: every edge of the map projected and clipped, nothing hidden.
class EveryEdge final : public render::Expectation {
 public:
  explicit EveryEdge(const world::Map& map) : map_(&map) {}
  void look(const geometry::Pose& X_WC, const geometry::Camera& camera,
            std::vector<render::VisiblePiece>& pieces) override;

 private:
  const world::Map* map_;
};

}  // namespace cgsr::localization
