#include "pipeline/global_localization/panorama.h"

#include <algorithm>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/localization/random_numbers.h"

namespace cgsr::global_localization {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr Sector kAllAround{.middle = 0.0, .half_width = kPi + 1.0, .min_elevation = -0.5, .max_elevation = 0.5};

struct Line {
  Eigen::Vector3d from;
  Eigen::Vector3d to;
};

/// Posts, boards and what stands askew, two metres about.
std::vector<Line> room(std::uint32_t seed) {
  localization::testing::RandomNumbers random(seed);
  std::vector<Line> lines;
  for (int i = 0; i < 20; ++i) {
    const double azimuth = random.uniform(-kPi, kPi);
    const Eigen::Vector3d foot(2.0 * std::cos(azimuth), 2.0 * std::sin(azimuth), random.uniform(-0.9, 0.3));
    const Eigen::Vector3d along(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), i % 2 == 0 ? 0.6 : 0.0);
    lines.push_back({foot, foot + along});
  }
  return lines;
}

Panorama panorama_of(const std::vector<Line>& lines, double turned_rad) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(turned_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Panorama panorama;
  for (const Line& line : lines) panorama.add(R * line.from, R * line.to, 1.0, kAllAround);
  panorama.finish();
  return panorama;
}

std::size_t best_of(const Panorama::Likeness& likeness) {
  return static_cast<std::size_t>(std::ranges::max_element(likeness) - likeness.begin());
}

TEST(Panorama, FindsTheTurnOfACopy) {
  const Panorama map = panorama_of(room(1), 0.0);
  for (const int cells : {0, 1, 37, 119}) {
    // Who has turned to the left by so much sees all of it so much farther to the right.
    const Panorama seen = panorama_of(room(1), -cells * 2.0 * kPi / Panorama::kAzimuths);
    const Panorama::Likeness likeness = map.compare(seen);
    EXPECT_EQ(best_of(likeness), static_cast<std::size_t>(cells));
    EXPECT_NEAR(*std::ranges::max_element(likeness), 1.0F, 0.02F);
  }
}

// All turns are compared at once, by their harmonics: each as if that turn alone had been made.
TEST(Panorama, ComparesEveryTurnAsIfItHadBeenMade) {
  const Panorama seen = panorama_of(room(2), 0.0);
  const Panorama::Likeness likeness = panorama_of(room(1), 0.0).compare(seen);
  for (int cells = 0; cells < Panorama::kAzimuths; ++cells) {
    const Panorama turned = panorama_of(room(1), -cells * 2.0 * kPi / Panorama::kAzimuths);
    EXPECT_NEAR(likeness[static_cast<std::size_t>(cells)], turned.compare(seen)[0], 0.01F) << cells;
  }
}

// Two posts of one height are alike by the product of their blurred cells.
TEST(Panorama, IsAlikeAsFarAsCellsOverlap) {
  const auto post_at = [](double cells) {
    const double azimuth = (cells + 0.5) * 2.0 * kPi / Panorama::kAzimuths;
    const Eigen::Vector3d foot(2.0 * std::cos(azimuth), 2.0 * std::sin(azimuth), -0.2);
    return panorama_of({{foot, foot + Eigen::Vector3d(0.0, 0.0, 0.4)}}, 0.0);
  };
  // Each post covers three cells, a quarter, a half, a quarter; less the mean of the row, 1 / 120.
  const auto expected = [](double product) { return (product - 1.0 / 120.0) / (0.375 - 1.0 / 120.0); };
  const Panorama::Likeness likeness = post_at(10).compare(post_at(10));
  EXPECT_NEAR(likeness[0], 1.0, 1e-3);
  EXPECT_NEAR(likeness[1], expected(0.25), 1e-3);
  EXPECT_NEAR(likeness[2], expected(0.0625), 1e-3);
  EXPECT_NEAR(likeness[3], expected(0.0), 1e-3);
  EXPECT_NEAR(post_at(12).compare(post_at(10))[2], 1.0, 1e-3);
}

TEST(Panorama, OfAnotherRoomIsLessAlike) {
  const Panorama seen = panorama_of(room(1), 0.7);
  const auto most_alike = [&](std::uint32_t seed) {
    const Panorama::Likeness likeness = panorama_of(room(seed), 0.0).compare(seen);
    return *std::ranges::max_element(likeness);
  };
  for (const std::uint32_t other : {2U, 3U, 4U, 5U}) EXPECT_LT(most_alike(other), 0.6F * most_alike(1)) << other;
}

// A skirting all around a round room tells no heading.
TEST(Panorama, TakesOutWhatIsTheSameAllAround) {
  std::vector<Line> ring;
  for (int i = 0; i < 360; ++i) {
    const auto point = [](int degree) {
      const double azimuth = degree * kPi / 180.0;
      return Eigen::Vector3d(2.0 * std::cos(azimuth), 2.0 * std::sin(azimuth), -0.5);
    };
    ring.push_back({point(i), point(i + 1)});
  }
  std::vector<Line> both = room(1);
  both.insert(both.end(), ring.begin(), ring.end());
  const Panorama map = panorama_of(room(1), 0.0);
  EXPECT_GT(map.compare(panorama_of(both, 0.0))[0], 0.85F);
}

TEST(Panorama, LeavesOutWhatLiesBesideTheSector) {
  const Sector ahead{.middle = 0.0, .half_width = 0.2, .min_elevation = -0.1, .max_elevation = 0.1};
  Panorama panorama;
  panorama.add({0.0, 2.0, -0.1}, {0.0, 2.0, 0.1}, 1.0, ahead);  // to the left
  panorama.add({2.0, 0.0, 0.8}, {2.0, 0.2, 0.8}, 1.0, ahead);   // above
  panorama.finish();
  for (const float likeness : panorama.compare(panorama_of(room(1), 0.0))) EXPECT_EQ(likeness, 0.0F);
}

}  // namespace
}  // namespace cgsr::global_localization
