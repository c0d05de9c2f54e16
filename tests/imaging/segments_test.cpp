#include "pipeline/imaging/segments.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/imaging/rendered_edges.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::imaging {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kDegree = 3.14159265358979 / 180.0;

std::span<const Segment> find(SegmentFinder& finder, const Bytes& bytes) {
  return finder.find(bytes.data(), kWidth, kHeight, kWidth);
}

Eigen::Vector2d direction(const Segment& segment) {
  return (segment.p1 - segment.p0).cast<double>().normalized();
}
double length(const Segment& segment) {
  return static_cast<double>((segment.p1 - segment.p0).norm());
}

/// Distance of the segment's middle from a line, with a sign: to the left of `along` is positive.
double offset_from(const Segment& segment, const Eigen::Vector2d& point, const Eigen::Vector2d& along) {
  const Eigen::Vector2d from = 0.5 * (segment.p0 + segment.p1).cast<double>() - point;
  return along.x() * from.y() - along.y() * from.x();
}

double angle_between(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)) / kDegree;
}

struct Spread {
  double sum = 0.0;
  double squares = 0.0;
  int n = 0;
  void add(double value) {
    sum += value;
    squares += value * value;
    ++n;
  }
  [[nodiscard]] double mean() const { return sum / n; }
  [[nodiscard]] double rms() const { return std::sqrt(squares / n); }
};

TEST(SegmentsProperty, LieWhereTheEdgeWasDrawnAndKnowTheBrighterSide) {
  std::mt19937 random(1);
  SegmentFinder finder({}, kWidth, kHeight);
  Spread offsets;
  Spread angles;
  Spread normalised;
  for (int trial = 0; trial < 150; ++trial) {
    const double angle =
        trial % 5 == 0 ? 45.0 * kDegree * static_cast<double>(random() % 8) : drawn::uniform(random, 0.0, 6.2832);
    const Eigen::Vector2d along = drawn::direction_of(angle);
    const Eigen::Vector2d brighter(-along.y(), along.x());
    const Eigen::Vector2d middle(drawn::uniform(random, 100.0, 220.0), drawn::uniform(random, 80.0, 160.0));
    const double change = drawn::uniform(random, 30.0, 120.0);
    // The border of a wide ribbon, 60 px long.
    drawn::Canvas canvas(kWidth, kHeight, 70.0);
    canvas.add_ribbon(middle + 15.0 * brighter, along, 60.0, 30.0, change, drawn::uniform(random, 0.4, 0.8));
    const Bytes bytes = canvas.bytes(random, 1.0);
    int found = 0;
    for (const Segment& segment : find(finder, bytes)) {
      const double turn = angle_between(along, direction(segment));
      if (std::abs(turn) > 5.0 || std::abs(offset_from(segment, middle, along)) > 3.0) continue;
      ++found;
      EXPECT_NEAR(length(segment), 57.0, 4.0);  // ends are trimmed
      EXPECT_NEAR(static_cast<double>(segment.contrast), change, 0.1 * change + 2.0);
      offsets.add(offset_from(segment, middle, along));
      angles.add(turn);
      normalised.add(offset_from(segment, middle, along) / static_cast<double>(segment.sigma_px));
    }
    EXPECT_EQ(found, 1) << "trial " << trial << ", " << angle / kDegree << " degrees";
  }
  RecordProperty("offset_rms_px", std::to_string(offsets.rms()));
  RecordProperty("angle_rms_deg", std::to_string(angles.rms()));
  RecordProperty("normalised_rms", std::to_string(normalised.rms()));
  EXPECT_LT(std::abs(offsets.mean()), 0.01);
  EXPECT_LT(offsets.rms(), 0.05);
  EXPECT_LT(angles.rms(), 0.1);
  EXPECT_LT(normalised.rms(), 1.3);
  EXPECT_GT(normalised.rms(), 0.2);
}

TEST(SegmentsProperty, BothBordersOfANarrowTape) {
  std::mt19937 random(2);
  SegmentFinder finder({}, kWidth, kHeight);
  for (const double tape : {2.5, 2.8, 3.2, 4.0, 6.0}) {
    Spread bias;
    int both = 0;
    constexpr int kTrials = 40;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Eigen::Vector2d along = drawn::direction_of(drawn::uniform(random, 0.0, 6.2832));
      const Eigen::Vector2d middle(drawn::uniform(random, 110.0, 210.0), drawn::uniform(random, 90.0, 150.0));
      drawn::Canvas canvas(kWidth, kHeight, 70.0);
      canvas.add_ribbon(middle, along, 80.0, tape, 100.0, 0.5);
      const Bytes bytes = canvas.bytes(random, 1.0);
      int sides[2] = {0, 0};
      for (const Segment& segment : find(finder, bytes)) {
        const double turn = std::abs(angle_between(along, direction(segment)));
        if (length(segment) < 60.0) continue;
        const double offset = offset_from(segment, middle, along);
        // Within the tape is brighter: left border of `along` runs against it.
        EXPECT_EQ(offset > 0.0, turn > 90.0);
        ++sides[offset > 0.0 ? 1 : 0];
        bias.add(std::abs(offset) - 0.5 * tape);
      }
      both += sides[0] == 1 && sides[1] == 1 ? 1 : 0;
    }
    RecordProperty("bias_px_at_" + std::to_string(tape), std::to_string(bias.mean()));
    EXPECT_GE(both, kTrials - 1) << tape;
    EXPECT_LT(std::abs(bias.mean()), 0.05) << tape;
    EXPECT_LT(bias.rms(), 0.08) << tape;
  }
}

TEST(SegmentsProperty, CrossingLinesAndCornersAreSplit) {
  std::mt19937 random(3);
  SegmentFinder finder({}, kWidth, kHeight);
  int corners_found = 0;
  for (int trial = 0; trial < 40; ++trial) {
    // A rectangle at any angle: four segments, each on its side.
    const double angle = drawn::uniform(random, 0.0, 6.2832);
    const Eigen::Vector2d along = drawn::direction_of(angle);
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d middle(160.0, 120.0);
    drawn::Canvas canvas(kWidth, kHeight, 70.0);
    canvas.add_ribbon(middle, along, 100.0, 70.0, 60.0, 0.5);
    const auto segments = find(finder, canvas.bytes(random, 1.0));
    EXPECT_EQ(segments.size(), 4U) << angle / kDegree;
    for (const Segment& segment : segments) {
      const double turn = std::abs(along.dot(direction(segment)));
      EXPECT_TRUE(turn < 0.01 || turn > 0.999);
      EXPECT_NEAR(length(segment), turn > 0.5 ? 97.0 : 67.0, 4.0);
    }
    corners_found += segments.size() == 4 ? 1 : 0;
  }
  EXPECT_EQ(corners_found, 40);

  // A chessboard's corner: four edges meet, and each colour change lies on one of two lines.
  for (int trial = 0; trial < 40; ++trial) {
    const double angle = drawn::uniform(random, 0.0, 6.2832);
    const Eigen::Vector2d a = drawn::direction_of(angle);
    const Eigen::Vector2d b = drawn::direction_of(angle + drawn::uniform(random, 50.0, 130.0) * kDegree);
    const Eigen::Vector2d middle(160.3, 120.7);
    drawn::Canvas one(kWidth, kHeight, -1.0);
    one.add_side(middle, {-a.y(), a.x()}, 2.0, 0.5);
    drawn::Canvas other(kWidth, kHeight, -1.0);
    other.add_side(middle, {-b.y(), b.x()}, 2.0, 0.5);
    drawn::Canvas canvas(kWidth, kHeight, 0.0);
    for (std::size_t i = 0; i < canvas.values.size(); ++i)
      canvas.values[i] = 120.0 + 40.0 * one.values[i] * other.values[i];
    for (const Segment& segment : find(finder, canvas.bytes(random, 1.0))) {
      if (length(segment) < 20.0) continue;
      const bool on_a = std::abs(a.dot(direction(segment))) > 0.9995 && std::abs(offset_from(segment, middle, a)) < 0.3;
      const bool on_b = std::abs(b.dot(direction(segment))) > 0.9995 && std::abs(offset_from(segment, middle, b)) < 0.3;
      EXPECT_TRUE(on_a || on_b) << angle / kDegree;
    }
  }
}

TEST(SegmentsProperty, SmallGapsAreBridgedAndGreatOnesNot) {
  std::mt19937 random(4);
  SegmentFinder finder({}, kWidth, kHeight);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector2d along = drawn::direction_of(drawn::uniform(random, 0.0, 6.2832));
    const Eigen::Vector2d brighter(-along.y(), along.x());
    for (const double gap : {3.0, 25.0}) {
      drawn::Canvas canvas(kWidth, kHeight, 70.0);
      canvas.add_ribbon(Eigen::Vector2d(160.0, 120.0) + 20.0 * brighter, along, 140.0, 40.0, 60.0, 0.5);
      // A notch in it.
      canvas.add_ribbon(Eigen::Vector2d(160.0, 120.0) + 20.0 * brighter, along, gap, 40.0, -60.0, 0.5);
      int pieces = 0;
      double longest = 0.0;
      for (const Segment& segment : find(finder, canvas.bytes(random, 1.0))) {
        if (std::abs(angle_between(along, direction(segment))) > 4.0) continue;
        if (std::abs(offset_from(segment, {160.0, 120.0}, along)) > 1.5) continue;
        ++pieces;
        longest = std::max(longest, length(segment));
      }
      if (gap > 10.0) {
        EXPECT_EQ(pieces, 2);
        EXPECT_LT(longest, 65.0);
      } else {
        EXPECT_EQ(pieces, 1);
        EXPECT_GT(longest, 130.0);
      }
    }
  }
}

TEST(SegmentsProperty, NoneInNoiseAlone) {
  std::mt19937 random(5);
  SegmentFinder finder({}, kWidth, kHeight);
  std::size_t segments = 0;
  for (const double deviation : {0.0, 1.0, 3.0, 6.0, 12.0}) {
    for (int trial = 0; trial < 4; ++trial) {
      segments += find(finder, drawn::Canvas(kWidth, kHeight, 128.0).bytes(random, deviation)).size();
    }
  }
  EXPECT_EQ(segments, 0U);
}

TEST(SegmentsFault, BlackAndSaturatedImagesAndTooManySegments) {
  SegmentParameters parameters;
  parameters.max_segments = 5;
  SegmentFinder finder(parameters, kWidth, kHeight);
  EXPECT_TRUE(find(finder, Bytes(kWidth * kHeight, 0)).empty());
  EXPECT_TRUE(find(finder, Bytes(kWidth * kHeight, 255)).empty());
  EXPECT_TRUE(finder.find(nullptr, kWidth + 1, kHeight, kWidth + 1).empty());

  Bytes bytes(kWidth * kHeight, 100);
  for (int bar = 0; bar < 10; ++bar) {  // the longer the farther right
    for (int y = 10; y < 30 + 15 * bar; ++y)
      std::fill_n(bytes.begin() + y * kWidth + 15 + 30 * bar, 12, std::uint8_t{200});
  }
  const auto segments = find(finder, bytes);
  ASSERT_EQ(segments.size(), 5U);
  for (const Segment& segment : segments) EXPECT_GT(segment.p0.x(), 180.0F);
}

TEST(SegmentsProperty, AnythingGoesInAndSegmentsOfTheImageComeOut) {
  std::mt19937 random(6);
  SegmentFinder finder({}, 200, 150);
  for (int trial = 0; trial < 60; ++trial) {
    const int width = 16 + static_cast<int>(random() % 185);
    const int height = 16 + static_cast<int>(random() % 135);
    Bytes bytes(static_cast<std::size_t>(width * height));
    const unsigned coarse = 1U << (random() % 5);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const auto x = static_cast<unsigned>(i) % static_cast<unsigned>(width) / coarse;
      const auto y = static_cast<unsigned>(i) / static_cast<unsigned>(width) / coarse;
      bytes[i] = static_cast<std::uint8_t>((x * 2654435761U ^ y * 40503U ^ static_cast<unsigned>(trial) * 97U) >> 7U);
    }
    for (const Segment& segment : finder.find(bytes.data(), width, height, width)) {
      for (const Eigen::Vector2f& end : {segment.p0, segment.p1}) {
        EXPECT_GE(end.minCoeff(), 0.0F);
        EXPECT_LT(end.x(), static_cast<float>(width));
        EXPECT_LT(end.y(), static_cast<float>(height));
      }
      EXPECT_GT(segment.sigma_px, 0.0F);
      EXPECT_LT(segment.sigma_px, 1.0F);
    }
  }
}

TEST(SegmentsAlloc, NothingAfterConstruction) {
  if (!cgsr::test::AllocationGuard::counts()) GTEST_SKIP() << "SKIPPED: allocations are not counted in this build";
  std::mt19937 random(7);
  const Bytes bytes = drawn::cluttered(random, kWidth, kHeight, 30).bytes(random, 1.0);
  SegmentFinder finder({}, kWidth, kHeight);
  const cgsr::test::AllocationGuard guard;
  EXPECT_GT(find(finder, bytes).size(), 20U);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::imaging
