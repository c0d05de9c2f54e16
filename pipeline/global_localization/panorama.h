#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace cgsr::global_localization {

/// Which part of what is seen around a place an image stands for. Radians; azimuths count from the x axis to the left, elevations from the horizon up.
struct Sector {
  double middle = 0.0;
  double half_width = 0.0;
  double min_elevation = 0.0;
  double max_elevation = 0.0;
};

/// The straight edges around a place, coarsely: how much of them lies in which direction, by azimuth, elevation and the way they run there. Two
/// panoramas are compared in all turns against each other, so that one whose heading is not known has a likeness for each heading.
/// Ours: the dissertation starts from a known pose (4.1).
class Panorama {
 public:
  static constexpr int kAzimuths = 120;   ///< cells of 3 degrees.
  static constexpr int kElevations = 20;  ///< of 3 degrees, from 30 below to 30 above the horizon.
  static constexpr int kCourses = 4;  ///< ways an edge runs on the sphere: level, upright and between, 45 degrees each.

  /// By turn: index i is a turn of i azimuth cells.
  using Likeness = std::array<float, kAzimuths>;

  Panorama();

  void clear();

  /// Adds what of a straight edge lies in the sector.
  /// \param from, to  its ends as seen from the camera, axes x at azimuth 0, z up; any length but 0.  \param weight  of a radian of it.
  void add(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight, const Sector& sector);

  /// Between add() and compare(): what is seen at every azimuth alike is taken out, the whole is scaled to length 1, and harmonics are taken, for some .5
  /// million instructions. Nothing is added afterwards before clear().
  void finish();

  /// \return how alike this and another panorama are where the other one's azimuth 0 is this one's i-th cell: correlations, at most 1. By the product of
  /// their harmonics around the horizon: .04 million instructions, the sums themselves were 1.5.
  [[nodiscard]] Likeness compare(const Panorama& other) const;

 private:
  using Row = std::array<float, kAzimuths>;
  static constexpr int kHarmonics = kAzimuths / 2;

  [[nodiscard]] float* row(int course, int elevation) {
    return cells_.data() + static_cast<std::size_t>((course * kElevations + elevation) * kAzimuths);
  }
  [[nodiscard]] const float* row(int course, int elevation) const {
    return cells_.data() + static_cast<std::size_t>((course * kElevations + elevation) * kAzimuths);
  }
  void add_point(double azimuth, double elevation, double course, double amount);
  void blur();
  void take_harmonics();

  /// Rows of azimuths; once finished, the cosines of each row's harmonics and then their sines: the mean being gone, that is as much.
  std::vector<float> cells_;
  std::array<bool, static_cast<std::size_t>(kElevations* kCourses)> empty_{};  ///< rows that say nothing.
};

}  // namespace cgsr::global_localization
