#include "pipeline/color/ball/image_part.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "pipeline/imaging/color_code.h"
#include "tests/color/scene.h"

namespace cgsr::color {
namespace {

imaging::LabelTable some_table() {
  imaging::LabelTable table(imaging::kColorCodes);
  for (std::size_t code = 0; code < table.size(); ++code) table[code] = static_cast<std::uint16_t>(code % 61);
  return table;
}

// The straightforward way is to reduce the whole image and to look at the box in it: the part's pixels are the same.
TEST(ImagePart, IsReducedToTheImagesOwnPixels) {
  std::mt19937 random(20261125);
  auto scene = test::clutter(320, 240, random, 60);
  const ImageView image = scene.photograph(2.0);
  const imaging::LabelTable table = some_table();
  std::uniform_real_distribution<double> x(-30.0, 330.0);
  std::uniform_real_distribution<double> y(-30.0, 250.0);
  std::uniform_real_distribution<double> side(1.0, 90.0);
  for (const int factor : {1, 2}) {
    imaging::ReducedImage whole(320, 240);
    imaging::ReducedImage cut_out(320, 240);
    ASSERT_TRUE(imaging::reduce(image, factor, table, whole));
    for (int trial = 0; trial < 300; ++trial) {
      const Box box{x(random), y(random), side(random), side(random)};
      const ImagePart part = part_around(box, image);
      ASSERT_TRUE(imaging::reduce(cut(image, part), factor, table, cut_out)) << trial;
      ASSERT_EQ(part.left % 2, 0);
      ASSERT_EQ(part.top % 2, 0);
      const Box inside = intersection(box, {0.0, 0.0, 320.0, 240.0});
      if (inside.area() > 0.0) {
        EXPECT_LE(part.left, inside.x);
        EXPECT_LE(part.top, inside.y);
        EXPECT_GE(part.left + part.width, inside.x + inside.width);
        EXPECT_GE(part.top + part.height, inside.y + inside.height);
      }
      for (int row = 0; row < cut_out.height_px; ++row) {
        for (int column = 0; column < cut_out.width_px; ++column) {
          const int in_whole = (part.top / factor + row) * whole.width_px + part.left / factor + column;
          ASSERT_EQ(cut_out.labels[static_cast<std::size_t>(row * cut_out.width_px + column)],
                    whole.labels[static_cast<std::size_t>(in_whole)])
              << trial << ' ' << row << ' ' << column;
        }
      }
    }
  }
}

// Cell by cell: what a pixel's cell says decides whether its label stays.
TEST(ImagePart, KeepsTheLabelsOfTheMaskAlone) {
  std::mt19937 random(20261126);
  auto scene = test::clutter(320, 240, random, 60);
  const ImageView image = scene.photograph(2.0);
  const imaging::LabelTable table(imaging::kColorCodes, 7);
  std::vector<std::uint8_t> cells(40 * 30);
  for (auto& cell : cells) cell = random() % 3 == 0 ? 255 : 0;
  const ShadeMaskView mask{cells.data(), 40, 30, 40};
  const ImagePart part = part_around({50.0, 70.0, 100.0, 90.0}, image);
  for (const Kept kept : {Kept::kShaded, Kept::kLit}) {
    imaging::ReducedImage labels(320, 240);
    ASSERT_TRUE(imaging::reduce(cut(image, part), 2, table, labels));
    keep_only(kept, mask, image, part, labels);
    for (int row = 0; row < labels.height_px; ++row) {
      for (int column = 0; column < labels.width_px; ++column) {
        const int cell = (part.top + 2 * row) / 8 * 40 + (part.left + 2 * column) / 8;
        const bool shaded = cells[static_cast<std::size_t>(cell)] != 0;
        ASSERT_EQ(labels.labels[static_cast<std::size_t>(row * labels.width_px + column)] == 7,
                  shaded == (kept == Kept::kShaded))
            << row << ' ' << column;
      }
    }
  }
}

}  // namespace
}  // namespace cgsr::color
