#include "pipeline/global_localization/panorama.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace cgsr::global_localization {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kCell = 2.0 * kPi / Panorama::kAzimuths;  // radians
constexpr double kLowest = -kPi / 6.0;
constexpr double kStep = 0.5 * kCell;  // along an edge

int wrapped(int index, int count) {
  return ((index % count) + count) % count;
}

/// A number between two cells: the lower one, and the share of the upper one.
struct Between {
  explicit Between(double place) : lower(static_cast<int>(std::floor(place))), share(place - std::floor(place)) {}
  int lower;
  double share;
};

template <int kCount>
using RowOf = Eigen::Matrix<float, kCount, 1>;

/// The harmonics of a row of azimuths: one in each row of these.
struct Waves {
  static constexpr int kHarmonics = Panorama::kAzimuths / 2;
  Eigen::Matrix<float, kHarmonics, Panorama::kAzimuths> cosines, sines;
  /// With which the product of two rows' harmonics is that of the rows: the root of 2 / N, of 1 / N for the last one, which has no sine.
  RowOf<kHarmonics> scale = RowOf<kHarmonics>::Constant(std::sqrt(2.0F / Panorama::kAzimuths));

  static const Waves& get() {
    static const Waves waves;
    return waves;
  }

 private:
  Waves() {
    scale(kHarmonics - 1) *= std::sqrt(0.5F);
    for (int harmonic = 0; harmonic < kHarmonics; ++harmonic) {
      for (int cell = 0; cell < Panorama::kAzimuths; ++cell) {
        const double angle = (harmonic + 1) * cell * kCell;
        cosines(harmonic, cell) = static_cast<float>(std::cos(angle));
        sines(harmonic, cell) = static_cast<float>(std::sin(angle));
      }
    }
  }
};

}  // namespace

Panorama::Panorama() : cells_(static_cast<std::size_t>(kAzimuths * kElevations * kCourses)) {
  Waves::get();  // not in the first image that compares
}

void Panorama::clear() {
  std::ranges::fill(cells_, 0.0F);
}

void Panorama::add_point(double azimuth, double elevation, double course, double amount) {
  const Between a(azimuth / kCell - 0.5);
  const Between e((elevation - kLowest) / kCell - 0.5);
  const Between c(course / (kPi / kCourses));
  for (int corner = 0; corner < 8; ++corner) {
    const int da = corner & 1;
    const int de = (corner >> 1) & 1;
    const int dc = corner >> 2;
    if (e.lower + de < 0 || e.lower + de >= kElevations) continue;
    const double share =
        (da != 0 ? a.share : 1.0 - a.share) * (de != 0 ? e.share : 1.0 - e.share) * (dc != 0 ? c.share : 1.0 - c.share);
    row(wrapped(c.lower + dc, kCourses), e.lower + de)[wrapped(a.lower + da, kAzimuths)] +=
        static_cast<float>(amount * share);
  }
}

void Panorama::add(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight, const Sector& sector) {
  const double angle = std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0));
  const int steps = std::max(1, static_cast<int>(angle / kStep));
  Eigen::Vector3d before = from.normalized();
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Vector3d after = (from + (to - from) * (static_cast<double>(i) / steps)).normalized();
    const Eigen::Vector3d middle = (before + after).normalized();
    const Eigen::Vector3d along = after - before;
    before = after;
    const double azimuth = std::atan2(middle.y(), middle.x());
    const double elevation = std::asin(std::clamp(middle.z(), -1.0, 1.0));
    if (std::abs(std::remainder(azimuth - sector.middle, 2.0 * kPi)) > sector.half_width ||
        elevation < sector.min_elevation || elevation > sector.max_elevation)
      continue;
    const Eigen::Vector3d left(-std::sin(azimuth), std::cos(azimuth), 0.0);
    const Eigen::Vector3d up = middle.cross(left);
    const double course = std::atan2(along.dot(up), along.dot(left));
    add_point(azimuth, elevation, course < 0.0 ? course + kPi : course, weight * along.norm());
  }
}

// By a cell to either side, a quarter each: places of the map lie a step apart, and headings a cell.
void Panorama::blur() {
  for (int course = 0; course < kCourses; ++course) {
    Row below{};  // the row below as it was
    for (int elevation = 0; elevation < kElevations; ++elevation) {
      float* const here = row(course, elevation);
      Row was;
      std::copy_n(here, kAzimuths, was.begin());
      const float* const above = elevation + 1 < kElevations ? row(course, elevation + 1) : nullptr;
      for (int a = 0; a < kAzimuths; ++a) {
        const auto i = static_cast<std::size_t>(a);
        here[a] = 0.25F * below[i] + 0.5F * was[i] + 0.25F * (above != nullptr ? above[a] : 0.0F);
      }
      below = was;
    }
    for (int elevation = 0; elevation < kElevations; ++elevation) {
      float* const here = row(course, elevation);
      Row was;
      std::copy_n(here, kAzimuths, was.begin());
      for (int a = 0; a < kAzimuths; ++a) {
        here[a] = 0.25F * was[static_cast<std::size_t>(wrapped(a - 1, kAzimuths))] +
                  0.5F * was[static_cast<std::size_t>(a)] +
                  0.25F * was[static_cast<std::size_t>(wrapped(a + 1, kAzimuths))];
      }
    }
  }
}

void Panorama::finish() {
  // Twenty books on a shelf do not count twenty times as much as its side.
  for (float& cell : cells_) cell = std::sqrt(cell);
  blur();
  double squares = 0.0;
  for (int course = 0; course < kCourses; ++course) {
    for (int elevation = 0; elevation < kElevations; ++elevation) {
      float* const here = row(course, elevation);
      float mean = 0.0F;
      for (int a = 0; a < kAzimuths; ++a) mean += here[a] / kAzimuths;
      float most = 0.0F;
      for (int a = 0; a < kAzimuths; ++a) {
        here[a] -= mean;
        squares += static_cast<double>(here[a]) * static_cast<double>(here[a]);
        most = std::max(most, std::abs(here[a]));
      }
      empty_[static_cast<std::size_t>(course * kElevations + elevation)] = most == 0.0F;
    }
  }
  if (squares <= 0.0) return;
  const auto scale = static_cast<float>(1.0 / std::sqrt(squares));
  for (float& cell : cells_) cell *= scale;
  take_harmonics();
}

void Panorama::take_harmonics() {
  const Waves& waves = Waves::get();
  for (int course = 0; course < kCourses; ++course) {
    for (int elevation = 0; elevation < kElevations; ++elevation) {
      if (empty_[static_cast<std::size_t>(course * kElevations + elevation)]) continue;
      Eigen::Map<RowOf<kAzimuths>> cells(row(course, elevation));
      // A cell and the one as far to the other side have the same cosines, and sines of opposite signs.
      RowOf<kHarmonics> cosines = cells(0) * waves.cosines.col(0) + cells(kHarmonics) * waves.cosines.col(kHarmonics);
      RowOf<kHarmonics> sines = RowOf<kHarmonics>::Zero();
      for (int a = 1; a < kHarmonics; ++a) {
        cosines += (cells(a) + cells(kAzimuths - a)) * waves.cosines.col(a);
        sines += (cells(a) - cells(kAzimuths - a)) * waves.sines.col(a);
      }
      cells << waves.scale.cwiseProduct(cosines), waves.scale.cwiseProduct(sines);
    }
  }
}

Panorama::Likeness Panorama::compare(const Panorama& other) const {
  RowOf<kHarmonics> cosines = RowOf<kHarmonics>::Zero();
  RowOf<kHarmonics> sines = RowOf<kHarmonics>::Zero();
  for (int course = 0; course < kCourses; ++course) {
    for (int elevation = 0; elevation < kElevations; ++elevation) {
      const auto index = static_cast<std::size_t>(course * kElevations + elevation);
      if (empty_[index] || other.empty_[index]) continue;
      const Eigen::Map<const RowOf<kHarmonics>> my_cosines(row(course, elevation));
      const Eigen::Map<const RowOf<kHarmonics>> my_sines(row(course, elevation) + kHarmonics);
      const Eigen::Map<const RowOf<kHarmonics>> their_cosines(other.row(course, elevation));
      const Eigen::Map<const RowOf<kHarmonics>> their_sines(other.row(course, elevation) + kHarmonics);
      cosines.array() += my_cosines.array() * their_cosines.array() + my_sines.array() * their_sines.array();
      sines.array() += my_sines.array() * their_cosines.array() - my_cosines.array() * their_sines.array();
    }
  }
  const Waves& waves = Waves::get();
  Likeness likeness;
  for (int turn = 0; turn < kAzimuths; ++turn) {
    likeness[static_cast<std::size_t>(turn)] = waves.cosines.col(turn).dot(cosines) + waves.sines.col(turn).dot(sines);
  }
  return likeness;
}

}  // namespace cgsr::global_localization
