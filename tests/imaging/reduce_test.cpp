#include "pipeline/imaging/reduce.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "tests/support/allocation_guard.h"

namespace cgsr::imaging {
namespace {

struct Camera {
  Camera(int width, int height, int padding, std::mt19937& random)
      : bytes(static_cast<std::size_t>((width * 2 + padding) * height)),
        view{bytes.data(), width, height, width * 2 + padding, PixelFormat::kYuyv} {
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  }
  std::vector<std::uint8_t> bytes;
  ImageView view;

  [[nodiscard]] int luma(int x, int y) const { return view.row(y)[x * 2]; }
  [[nodiscard]] int u(int pair, int y) const { return view.row(y)[pair * 4 + 1]; }
  [[nodiscard]] int v(int pair, int y) const { return view.row(y)[pair * 4 + 3]; }
};

LabelTable codes_themselves() {
  LabelTable table(kColorCodes);
  std::iota(table.begin(), table.end(), std::uint16_t{0});
  return table;
}

TEST(ReduceProperty, HalvesAsTheFormulaSaysForEverySize) {
  std::mt19937 random(11);
  const auto table = codes_themselves();
  for (int trial = 0; trial < 400; ++trial) {
    const int width = 16 + 2 * static_cast<int>(random() % 40);
    const int height = 16 + static_cast<int>(random() % 30);
    const Camera camera(width, height, static_cast<int>(random() % 3) * 5, random);
    ReducedImage out(width, height);

    ASSERT_TRUE(reduce(camera.view, 2, table, out));

    ASSERT_EQ(out.width_px, width / 2);
    ASSERT_EQ(out.height_px, height / 2);
    for (int y = 0; y < out.height_px; ++y) {
      for (int x = 0; x < out.width_px; ++x) {
        const int y4 = camera.luma(2 * x, 2 * y) + camera.luma(2 * x + 1, 2 * y) + camera.luma(2 * x, 2 * y + 1) +
                       camera.luma(2 * x + 1, 2 * y + 1);
        const auto code =
            color_code(y4, camera.u(x, 2 * y) + camera.u(x, 2 * y + 1), camera.v(x, 2 * y) + camera.v(x, 2 * y + 1));
        const auto at = static_cast<std::size_t>(y * out.width_px + x);
        ASSERT_EQ(out.grey[at], (y4 + 2) / 4) << width << 'x' << height << " at " << x << ',' << y;
        ASSERT_EQ(out.labels[at], code) << width << 'x' << height << " at " << x << ',' << y;
      }
    }
  }
}

TEST(ReduceProperty, KeepsEveryPixelAtFactorOne) {
  std::mt19937 random(12);
  const auto table = codes_themselves();
  for (int trial = 0; trial < 200; ++trial) {
    const int width = 16 + 2 * static_cast<int>(random() % 40);
    const int height = 16 + static_cast<int>(random() % 30);
    const Camera camera(width, height, 0, random);
    ReducedImage out(width, height);

    ASSERT_TRUE(reduce(camera.view, 1, table, out));

    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto at = static_cast<std::size_t>(y * width + x);
        ASSERT_EQ(out.grey[at], camera.luma(x, y));
        ASSERT_EQ(out.labels[at], color_code(4 * camera.luma(x, y), 2 * camera.u(x / 2, y), 2 * camera.v(x / 2, y)));
      }
    }
  }
}

TEST(ReduceFault, SaysWhatItCannotTake) {
  std::mt19937 random(13);
  const Camera camera(64, 48, 0, random);
  const auto table = codes_themselves();
  ReducedImage out(64, 48);
  const auto failure = [&](ImageView view, int factor, const LabelTable& labels) {
    return reduce(view, factor, labels, out).error();
  };
  const auto with = [&](auto change) {
    ImageView view = camera.view;
    change(view);
    return view;
  };

  EXPECT_EQ(failure({}, 2, table), ReduceFailure::kNotYuyv);
  EXPECT_EQ(failure(with([](ImageView& v) { v.format = PixelFormat::kGrey8; }), 2, table), ReduceFailure::kNotYuyv);
  EXPECT_EQ(failure(camera.view, 3, table), ReduceFailure::kBadFactor);
  EXPECT_EQ(failure(camera.view, 0, table), ReduceFailure::kBadFactor);
  EXPECT_EQ(failure(camera.view, 2, LabelTable(100)), ReduceFailure::kBadTable);
  EXPECT_EQ(failure(with([](ImageView& v) { v.width_px = 14; }), 2, table), ReduceFailure::kBadSize);
  EXPECT_EQ(failure(with([](ImageView& v) { v.height_px = 15; }), 2, table), ReduceFailure::kBadSize);
  EXPECT_EQ(failure(with([](ImageView& v) { v.width_px = 63; }), 2, table), ReduceFailure::kBadSize);
  ReducedImage small(32, 48);
  EXPECT_EQ(reduce(camera.view, 1, table, small).error(), ReduceFailure::kBadSize);
}

TEST(ReduceAlloc, NothingAfterConstruction) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  std::mt19937 random(14);
  const Camera camera(640, 480, 0, random);
  const auto table = codes_themselves();
  ReducedImage out(640, 480);
  const test::AllocationGuard guard;
  ASSERT_TRUE(reduce(camera.view, 2, table, out));
  ASSERT_TRUE(reduce(camera.view, 1, table, out));
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(Reduction, KeepsEnoughPixelsOfSmallThings) {
  EXPECT_EQ(reduction_for(640, 480, 48), 2);
  EXPECT_EQ(reduction_for(640, 480, 17), 2);  // a large image stays affordable
  EXPECT_EQ(reduction_for(360, 240, 17), 1);
  EXPECT_EQ(reduction_for(360, 240, 40), 2);
  EXPECT_EQ(reduction_for(128, 96, 31), 1);
}

}  // namespace
}  // namespace cgsr::imaging
