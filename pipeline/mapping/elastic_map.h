#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "pipeline/mapping/obj_map.h"
#include "pipeline/mapping/parameters.h"
#include "pipeline/world/map.h"
#include "platform/error.h"

namespace cgsr::mapping {

/// Two corners of one part: standard deviations of how they move against each other.
struct Tie {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double along_m = 0.01;   ///< along the line between them: the part is larger or smaller.
  double across_m = 0.01;  ///< across it: the part is turned.
};

/// A corner that lies on another part's triangle: it stays there.
struct Contact {
  std::uint32_t corner = 0;
  std::array<std::uint32_t, 3> on{};                  ///< corners of the triangle.
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();  ///< where in it; sum 1.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// A part of the map that a person would measure as one: what is named alike up to a '/'. In a file without names: what hangs together.
struct Part {
  std::string name;
  std::vector<std::uint32_t> corners;
};

/// A map that can be bent: its corners, each once however many faces share it, and what is known of how they move. Ours.
class ElasticMap {
 public:
  /// \param map  what the robot's loader makes of the same file.
  /// \return an error that says which corner of `map` is none of the file's: it was loaded with another scale or axis.
  static Result<ElasticMap> make(const ObjMap& file, world::Map map, const RefineParameters& parameters);

  [[nodiscard]] const std::vector<Eigen::Vector3d>& measured() const {
    return measured_;
  }  ///< where the file has the corners, W [m].
  [[nodiscard]] const std::vector<Eigen::Vector3d>& corners() const { return corners_; }  ///< where they are now.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  /// Whether a part, as it was measured, reaches the floor (z = 0).
  [[nodiscard]] bool stands_on_floor(std::uint32_t part) const;
  [[nodiscard]] const std::vector<Tie>& ties() const { return ties_; }
  [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }
  /// Standard deviation of each corner on its own, such that all of a part's together leave the part N(0, map_sigma_m) [m].
  [[nodiscard]] const std::vector<double>& sigmas() const { return sigmas_; }
  [[nodiscard]] std::uint32_t corner_of_vertex(std::uint32_t vertex) const { return corner_of_vertex_[vertex]; }
  [[nodiscard]] std::uint32_t corner_of_point(std::uint32_t point) const {
    return corner_of_point_[point];
  }  ///< of the file.
  [[nodiscard]] std::uint32_t part_of(std::uint32_t corner) const { return part_of_[corner]; }
  /// The ends of a map's edge.
  [[nodiscard]] std::array<std::uint32_t, 2> ends_of(std::uint32_t edge) const;

  /// The map as the robot sees it, with its corners where they are now.
  [[nodiscard]] const world::Map& map() const { return map_; }
  /// Moves the corners. \param corners  as many as measured().
  void move(const std::vector<Eigen::Vector3d>& corners);
  /// The file's points for corners: what ObjMap::points are then.
  [[nodiscard]] std::vector<Eigen::Vector3d> points(const ObjMap& file,
                                                    const std::vector<Eigen::Vector3d>& corners) const;

 private:
  Result<void> find_corners(const ObjMap& file);
  void find_parts(const ObjMap& file);
  void tie(const ObjMap& file, const RefineParameters& parameters);
  [[nodiscard]] Tie tie_between(std::uint32_t a, std::uint32_t b, const RefineParameters& parameters) const;
  void tie_nearest(const std::vector<std::uint32_t>& object_of, const Part& part, const RefineParameters& parameters);
  void find_contacts(const RefineParameters& parameters);

  world::Map map_;
  std::vector<Eigen::Vector3d> measured_;
  std::vector<Eigen::Vector3d> corners_;
  std::vector<std::uint32_t> corner_of_point_;
  std::vector<std::uint32_t> corner_of_vertex_;
  std::vector<std::uint32_t> part_of_;
  std::vector<Part> parts_;
  std::vector<Tie> ties_;
  std::vector<Contact> contacts_;
  std::vector<double> sigmas_;
};

}  // namespace cgsr::mapping
