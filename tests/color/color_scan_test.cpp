#include "pipeline/color/track/color_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "platform/image_view.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::color {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr std::array<std::uint8_t, 3> kObject{120, 90, 190}, kGround{90, 128, 128}, kOther{120, 190, 90};

/// A YUYV image of one colour, in which boxes have others.
class Painted {
 public:
  Painted() : bytes_(std::size_t{2} * kWidth * kHeight) { paint({0, 0, kWidth, kHeight}, kGround); }

  void paint(const Box& box, const std::array<std::uint8_t, 3>& yuv) {
    for (int y = static_cast<int>(box.y); y < static_cast<int>(box.y + box.height); ++y) {
      for (int x = static_cast<int>(box.x); x < static_cast<int>(box.x + box.width); ++x) {
        std::uint8_t* at = bytes_.data() + std::size_t{2} * static_cast<std::size_t>(y * kWidth + x);
        at[0] = yuv[0];
        at[1] = x % 2 == 0 ? yuv[1] : yuv[2];
      }
    }
  }

  [[nodiscard]] imaging::Pyramid pyramid() const {
    imaging::Pyramid pyramid(kWidth, kHeight);
    pyramid.build({bytes_.data(), kWidth, kHeight, 2 * kWidth, PixelFormat::kYuyv});
    return pyramid;
  }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// Has learned kObject before kGround.
ColorLikelihood learned() {
  ColorPatch patch({64, 64});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool inside = x >= 20 && x < 44 && y >= 20 && y < 44;
      const auto& color = inside ? kObject : kGround;
      const auto at = static_cast<std::size_t>(y * 64 + x);
      patch.y[at] = color[0];
      patch.u[at] = color[1];
      patch.v[at] = color[2];
    }
  }
  ColorLikelihood colors;
  colors.learn(patch, {20, 20, 24, 24}, {20, 20, 24, 24}, 1.0);
  return colors;
}

TEST(ColorScan, NamesTheObjectsPlaceFirst) {
  const Box there{200, 100, 40, 60};
  Painted image;
  image.paint(there, kObject);
  image.paint({40, 40, 60, 60}, kOther);
  ColorScan scan;
  const auto places = scan.places(image.pyramid(), learned(), {1.0, 1.0, 1.0}, {0, 0, 40, 60});
  ASSERT_FALSE(places.empty());
  EXPECT_GT(intersection_over_union(places.front(), there), 0.6);
}

TEST(ColorScan, NamesNothingWhereNothingStandsOut) {
  ColorScan scan;
  EXPECT_TRUE(scan.places(Painted().pyramid(), learned(), {1.0, 1.0, 1.0}, {0, 0, 40, 60}).empty());
}

// What has the object's colours of before is something else.
TEST(ColorScan, LooksUnderThePresentLight) {
  const auto under = [](const std::array<std::uint8_t, 3>& yuv, const Light& light) {
    ColorPatch patch({1, 1});
    patch.y[0] = yuv[0];
    patch.u[0] = yuv[1];
    patch.v[0] = yuv[2];
    relight(patch, light);
    return std::array{patch.y[0], patch.u[0], patch.v[0]};
  };
  const Light light{0.6, 0.6, 1.0};
  const Box there{200, 100, 40, 60};
  Painted image;
  image.paint({0, 0, kWidth, kHeight}, under(kGround, light));
  image.paint(there, under(kObject, light));
  image.paint({40, 100, 40, 60}, kObject);
  ColorScan scan;
  const auto places = scan.places(image.pyramid(), learned(), light, {0, 0, 40, 60});
  ASSERT_FALSE(places.empty());
  EXPECT_GT(intersection_over_union(places.front(), there), 0.6);
}

TEST(ColorScan, KnowsItNearerAndFartherToo) {
  for (const double scale : {0.7, 1.4}) {
    const Box there{120, 80, 40 * scale, 60 * scale};
    Painted image;
    image.paint(there, kObject);
    ColorScan scan;
    const auto places = scan.places(image.pyramid(), learned(), {1.0, 1.0, 1.0}, {0, 0, 40, 60});
    ASSERT_FALSE(places.empty());
    EXPECT_GT(intersection_over_union(places.front(), there), 0.6) << scale;
  }
}

TEST(ColorScan, NamesDifferentPlacesOnly) {
  Painted image;
  const std::array<Box, 3> there{Box{20, 20, 40, 60}, Box{150, 30, 40, 60}, Box{240, 150, 40, 60}};
  for (const Box& box : there) image.paint(box, kObject);
  ColorScan scan;
  const auto places = scan.places(image.pyramid(), learned(), {1.0, 1.0, 1.0}, {0, 0, 40, 60});
  ASSERT_GE(places.size(), there.size());
  for (const Box& box : there) {
    EXPECT_TRUE(std::any_of(places.begin(), places.begin() + 3, [&](const Box& place) {
      return intersection_over_union(place, box) > 0.5;
    })) << box.x;
  }
}

TEST(ColorScan, CopesWithAnObjectLargerThanTheImageAndOneOfAPixel) {
  ColorScan scan;
  Painted image;
  image.paint({100, 100, 8, 8}, kObject);
  const auto pyramid = image.pyramid();
  EXPECT_TRUE(scan.places(pyramid, learned(), {1.0, 1.0, 1.0}, {0, 0, 900, 900}).empty());
  EXPECT_FALSE(scan.places(pyramid, learned(), {1.0, 1.0, 1.0}, {0, 0, 1, 1}).empty());
}

TEST(ColorScan, AllocatesNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  ColorScan scan;
  const Painted image;
  const auto pyramid = image.pyramid();
  const auto colors = learned();
  const test::AllocationGuard guard;
  scan.places(pyramid, colors, {1.0, 1.0, 1.0}, {0, 0, 1, 1});
  scan.places(pyramid, colors, {0.8, 1.0, 1.0}, {0, 0, 60, 30});
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::color
