#include "pipeline/imaging/pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "tests/support/allocation_guard.h"

namespace cgsr::imaging {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A YUYV image of exactly its bytes, so that a sanitizer sees what reads past them.
struct Camera {
  Camera(int width, int height, int padding, const std::function<double(int, int, int)>& value)
      : bytes(static_cast<std::size_t>((width * 2 + padding) * (height - 1) + width * 2)),
        view{bytes.data(), width, height, width * 2 + padding, PixelFormat::kYuyv} {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        std::uint8_t* pixel = bytes.data() + y * view.stride_bytes + 2 * x;
        pixel[0] = static_cast<std::uint8_t>(std::lround(value(0, x, y)));
        pixel[1] = static_cast<std::uint8_t>(std::lround(value(1 + x % 2, x / 2 * 2, y)));
      }
    }
  }
  Bytes bytes;
  ImageView view;

  [[nodiscard]] int luma(int x, int y) const { return view.row(y)[2 * x]; }
  [[nodiscard]] int u(int pair, int y) const { return view.row(y)[4 * pair + 1]; }
  [[nodiscard]] int v(int pair, int y) const { return view.row(y)[4 * pair + 3]; }
};

Camera noise(int width, int height, int padding, std::mt19937& random) {
  return {width, height, padding, [&](int, int, int) { return static_cast<double>(random() % 256); }};
}

int value(const Plane& plane, int x, int y) {
  return plane.data[y * plane.stride_bytes + static_cast<std::ptrdiff_t>(x) * plane.pixel_stride];
}

void expect_halved(const Plane& fine, const Plane& coarse) {
  ASSERT_EQ(coarse.width_px, fine.width_px / 2);
  ASSERT_EQ(coarse.height_px, fine.height_px / 2);
  for (int y = 0; y < coarse.height_px; ++y) {
    for (int x = 0; x < coarse.width_px; ++x) {
      const int sum = value(fine, 2 * x, 2 * y) + value(fine, 2 * x + 1, 2 * y) + value(fine, 2 * x, 2 * y + 1) +
                      value(fine, 2 * x + 1, 2 * y + 1);
      ASSERT_EQ(value(coarse, x, y), (sum + 2) / 4) << x << ',' << y;
    }
  }
}

TEST(PyramidProperty, EachLevelIsTheMeansOfTheOneBefore) {
  std::mt19937 random(21);
  for (int trial = 0; trial < 150; ++trial) {
    const int width = 16 + 2 * static_cast<int>(random() % 90), height = 16 + static_cast<int>(random() % 150);
    const Camera camera = noise(width, height, static_cast<int>(random() % 3) * 6, random);
    Pyramid pyramid(200, 170);

    pyramid.build(camera.view);

    int levels = 2;
    while (levels < Pyramid::kLevels && std::min(width, height) >> levels >= 8) ++levels;
    ASSERT_EQ(pyramid.levels(), levels) << width << 'x' << height;
    ASSERT_EQ(pyramid.width_px(), width);
    ASSERT_EQ(pyramid.height_px(), height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) ASSERT_EQ(value(pyramid.luma(0), x, y), camera.luma(x, y));
    }
    for (int y = 0; y < height / 2; ++y) {
      for (int x = 0; x < width / 2; ++x) {
        ASSERT_EQ(value(pyramid.chroma_u(1), x, y), (camera.u(x, 2 * y) + camera.u(x, 2 * y + 1) + 1) / 2);
        ASSERT_EQ(value(pyramid.chroma_v(1), x, y), (camera.v(x, 2 * y) + camera.v(x, 2 * y + 1) + 1) / 2);
      }
    }
    for (int level = 1; level < levels; ++level) {
      expect_halved(pyramid.luma(level - 1), pyramid.luma(level));
      if (level < 2) continue;
      expect_halved(pyramid.chroma_u(level - 1), pyramid.chroma_u(level));
      expect_halved(pyramid.chroma_v(level - 1), pyramid.chroma_v(level));
    }
    if (HasFatalFailure()) return;
  }
}

/// Bilinear interpolation in double between the centres of a plane's pixels; beyond the border the border repeats.
double interpolated(const Plane& plane, double x, double y) {
  x = std::clamp(x, 0.0, plane.width_px - 1.0);
  y = std::clamp(y, 0.0, plane.height_px - 1.0);
  const int left = std::min(static_cast<int>(x), plane.width_px - 2);
  const int top = std::min(static_cast<int>(y), plane.height_px - 2);
  const double fx = x - left, fy = y - top;
  return (1 - fy) * ((1 - fx) * value(plane, left, top) + fx * value(plane, left + 1, top)) +
         fy * ((1 - fx) * value(plane, left, top + 1) + fx * value(plane, left + 1, top + 1));
}

void expect_sampled(const Plane& plane, int level, const Box& region, PatchSize size, const Bytes& patch) {
  // Weights are cut off to 1/128 along each axis: at most two grey levels of a full step each, and positions to 1/65536 per sample.
  constexpr double kTolerance = 6.0;
  double sum = 0.0;
  for (int j = 0; j < size.height_px; ++j) {
    for (int i = 0; i < size.width_px; ++i) {
      const double x = (region.x + (i + 0.5) * region.width / size.width_px) / (1 << level) - 0.5;
      const double y = (region.y + (j + 0.5) * region.height / size.height_px) / (1 << level) - 0.5;
      const double error = patch[static_cast<std::size_t>(j * size.width_px + i)] - interpolated(plane, x, y);
      ASSERT_LT(std::abs(error), kTolerance) << "level " << level << " at " << i << ',' << j;
      sum += std::abs(error);
    }
  }
  ASSERT_LT(sum / static_cast<double>(size.area()), 1.5);
}

// On noise, where a wrong pixel or level cannot hide: regions inside, across and beyond the border, enlarged and reduced.
TEST(PyramidProperty, SamplesBilinearlyAtTheNextFinerLevel) {
  std::mt19937 random(22);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int levels_seen = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const int width = 64 + 2 * static_cast<int>(random() % 120), height = 64 + static_cast<int>(random() % 200);
    const Camera camera = noise(width, height, 0, random);
    Pyramid pyramid(width, height);
    pyramid.build(camera.view);
    const PatchSize size{1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70)};
    const double zoom = std::exp(3.5 * unit(random) - 1.0);
    const Box region{(1.4 * unit(random) - 0.4) * width, (1.4 * unit(random) - 0.4) * height,
                     zoom * size.width_px * (0.7 + unit(random)), zoom * size.height_px * (0.7 + unit(random))};
    const double step = std::min(region.width / size.width_px, region.height / size.height_px);
    int level = 0;
    while (step / (1 << level) >= 1.5 && level + 1 < pyramid.levels()) ++level;
    levels_seen |= 1 << level;
    Bytes y(size.area()), u(size.area()), v(size.area());

    pyramid.sample_luma(region, size, y);
    pyramid.sample_chroma(region, size, u, v);

    expect_sampled(pyramid.luma(level), level, region, size, y);
    const int chroma = std::max(1, level);
    expect_sampled(pyramid.chroma_u(chroma), chroma, region, size, u);
    expect_sampled(pyramid.chroma_v(chroma), chroma, region, size, v);
    if (HasFatalFailure()) {
      ADD_FAILURE() << trial << ": " << width << 'x' << height << " region " << region.x << ',' << region.y << ' '
                    << region.width << 'x' << region.height << " to " << size.width_px << 'x' << size.height_px;
      return;
    }
  }
  EXPECT_EQ(levels_seen, (1 << Pyramid::kLevels) - 1);
}

// No oracle by levels here: on a ramp every level says the same, and half a pixel of shift between them would show.
TEST(PyramidProperty, ARampStaysARampAtEveryLevel) {
  constexpr double kRounding =
      2.2;  // half up at every level, on a ramp always the same way; half a coarse pixel would be 4
  std::mt19937 random(23);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto ramp = [](int channel, double x, double y) {
    return channel == 0 ? 10 + 0.5 * x + 0.3 * y : channel == 1 ? 200 - 0.5 * x : 60 + 0.5 * y;
  };
  const Camera camera(320, 240, 0, [&](int channel, int x, int y) {
    return ramp(channel, x + (channel == 0 ? 0.5 : 1.0), y + 0.5);  // a chroma value stands for two pixels
  });
  Pyramid pyramid(320, 240);
  pyramid.build(camera.view);
  for (int trial = 0; trial < 400; ++trial) {
    const PatchSize size{2 + static_cast<int>(random() % 62), 2 + static_cast<int>(random() % 62)};
    const double width = 4 + 250 * unit(random), height = 4 + 180 * unit(random);
    const Box region{16 + (288 - width) * unit(random), 16 + (208 - height) * unit(random), width, height};
    Bytes y(size.area()), u(size.area()), v(size.area());
    pyramid.sample_luma(region, size, y);
    pyramid.sample_chroma(region, size, u, v);
    for (int j = 0; j < size.height_px; ++j) {
      for (int i = 0; i < size.width_px; ++i) {
        const double px = region.x + (i + 0.5) * region.width / size.width_px;
        const double py = region.y + (j + 0.5) * region.height / size.height_px;
        if (px < 17 || px > 303 || py < 17 || py > 223) continue;  // nearer, a coarse pixel's half is border
        const auto at = static_cast<std::size_t>(j * size.width_px + i);
        ASSERT_NEAR(y[at], ramp(0, px, py), kRounding) << trial;
        ASSERT_NEAR(u[at], ramp(1, px, py), kRounding) << trial;
        ASSERT_NEAR(v[at], ramp(2, px, py), kRounding) << trial;
      }
    }
  }
}

TEST(Pyramid, AFineCheckerboardTurnsGreyInsteadOfIntoAnotherPattern) {
  const Camera camera(320, 240, 0, [](int channel, int x, int y) { return channel > 0 ? 128 : (x + y) % 2 * 200; });
  Pyramid pyramid(320, 240);
  pyramid.build(camera.view);
  const PatchSize size{48, 40};
  Bytes patch(size.area());
  pyramid.sample_luma({3.3, 2.7, 310.0, 230.0}, size, patch);
  for (const int pixel : patch) ASSERT_EQ(pixel, 100);
}

TEST(Pyramid, TheMeanIsThatOfTheImage) {
  std::mt19937 random(24);
  const Camera camera(320, 240, 0, [&](int channel, int x, int y) {
    return channel == 0 ? static_cast<double>((x + y) / 3 % 256) : channel == 1 ? 90.0 : 30.0 + y / 4.0;
  });
  double y_sum = 0.0;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) y_sum += camera.luma(x, y);
  }
  Pyramid pyramid(640, 480);
  pyramid.build(camera.view);
  EXPECT_NEAR(pyramid.mean().y, y_sum / (320 * 240), 1.0);
  EXPECT_NEAR(pyramid.mean().u, 90.0, 0.01);
  EXPECT_NEAR(pyramid.mean().v, 30.0 + 119.5 / 4, 1.5);  // each level rounds half up
}

// Wider than what is blended at once, in an image too flat for coarse levels.
TEST(Pyramid, AVeryWideRegionIsStillInPlace) {
  const Camera camera(2048, 16, 0, [](int channel, int x, int) { return channel == 0 ? x / 10.0 : 128.0; });
  Pyramid pyramid(2048, 16);
  pyramid.build(camera.view);
  const PatchSize size{64, 8};
  Bytes patch(size.area());
  pyramid.sample_luma({0.0, 0.0, 2048.0, 16.0}, size, patch);
  for (int i = 0; i < 64; ++i) ASSERT_NEAR(patch[static_cast<std::size_t>(i)], (i + 0.5) * 3.2, 1.0) << i;
}

TEST(Pyramid, CountsItsImages) {
  std::mt19937 random(25);
  const Camera camera = noise(32, 32, 0, random);
  Pyramid pyramid(32, 32);
  EXPECT_EQ(pyramid.builds(), 0U);
  pyramid.build(camera.view);
  pyramid.build(camera.view);
  EXPECT_EQ(pyramid.builds(), 2U);
}

TEST(PyramidAlloc, NothingAfterConstruction) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(26);
  const Camera large = noise(640, 480, 0, random), small = noise(320, 200, 0, random);
  Pyramid pyramid(640, 480);
  const PatchSize size{64, 64};
  Bytes y(size.area()), u(size.area()), v(size.area());
  const test::AllocationGuard guard;
  for (const auto* camera : {&large, &small}) {
    pyramid.build(camera->view);
    pyramid.sample_luma({10, 10, 300, 300}, size, y);
    pyramid.sample_chroma({-10, -10, 30, 30}, size, u, v);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::imaging
