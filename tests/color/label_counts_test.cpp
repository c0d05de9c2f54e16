#include "pipeline/color/search/label_counts.h"

#include <gtest/gtest.h>

#include <random>

namespace cgsr::color {
namespace {

struct Labelled {
  Labelled(int width_px, int height_px, int labels, std::mt19937& random) : image(width_px, height_px) {
    image.factor = 1;
    image.width_px = width_px;
    image.height_px = height_px;
    // Runs of one label, as real images have them.
    int left = 0;
    std::uint16_t label = 0;
    for (auto& pixel : image.labels) {
      if (left-- == 0) {
        left = static_cast<int>(random() % 6);
        label = static_cast<std::uint16_t>(random() % static_cast<unsigned>(labels + 1));
      }
      pixel = label;
    }
  }
  imaging::ReducedImage image;
};

std::vector<int> count(const imaging::ReducedImage& image, const WindowGrid& grid, const CellRect& rect, int labels) {
  std::vector<int> counts(static_cast<std::size_t>(labels) + 1, 0);
  for (int y = (grid.top + rect.top) * grid.cell_px; y < (grid.top + rect.bottom) * grid.cell_px; ++y) {
    for (int x = (grid.left + rect.left) * grid.cell_px; x < (grid.left + rect.right) * grid.cell_px; ++x) {
      ++counts[image.labels[static_cast<std::size_t>(y * image.width_px + x)]];
    }
  }
  return counts;
}

// Any rectangle of any grid: exact() is what counting gives, cover() is never less, and neither more than the promised pixels.
TEST(LabelCountsProperty, AnyRectangleIsWhatCountingGives) {
  std::mt19937 random(51);
  for (int trial = 0; trial < 300; ++trial) {
    const int labels = 1 + static_cast<int>(random() % 70);
    const int width = 16 + static_cast<int>(random() % 60), height = 16 + static_cast<int>(random() % 60);
    Labelled labelled(width, height, labels, random);
    LabelCounts counts(labels, width * height, std::max(width, height));
    LabelHistogram histogram(labels);
    WindowGrid grid;
    grid.factor = 1;
    grid.cell_px = 1 + static_cast<int>(random() % 9);
    grid.right = width / grid.cell_px;
    grid.bottom = height / grid.cell_px;
    grid.left = static_cast<int>(random() % static_cast<unsigned>(grid.right));
    grid.top = static_cast<int>(random() % static_cast<unsigned>(grid.bottom));
    ASSERT_TRUE(counts.prepare(labelled.image, grid));
    for (int question = 0; question < 40; ++question) {
      const int across = grid.right - grid.left, down = grid.bottom - grid.top;
      CellRect rect;
      rect.left = static_cast<int>(random() % static_cast<unsigned>(across));
      rect.top = static_cast<int>(random() % static_cast<unsigned>(down));
      rect.right = rect.left + 1 + static_cast<int>(random() % static_cast<unsigned>(across - rect.left));
      rect.bottom = rect.top + 1 + static_cast<int>(random() % static_cast<unsigned>(down - rect.top));
      const auto expected = count(labelled.image, grid, rect, labels);

      counts.exact(rect, histogram);
      for (int label = 1; label <= labels; ++label) {
        ASSERT_EQ(histogram.counts()[label], expected[static_cast<std::size_t>(label)]) << trial << " label " << label;
      }

      counts.cover(rect, histogram);
      long covered = 0;
      for (int label = 1; label <= labels; ++label) {
        ASSERT_GE(histogram.counts()[label], expected[static_cast<std::size_t>(label)]) << trial << " label " << label;
        covered += histogram.counts()[label];
      }
      ASSERT_LE(covered, counts.covered_pixels(rect));
    }
  }
}

TEST(LabelCounts, RefusesALargerImageThanReserved) {
  std::mt19937 random(52);
  Labelled labelled(200, 200, 3, random);
  LabelCounts counts(3, 64 * 64, 64);
  WindowGrid grid;
  grid.cell_px = 1;
  grid.right = grid.bottom = 200;
  EXPECT_FALSE(counts.prepare(labelled.image, grid));
}

}  // namespace
}  // namespace cgsr::color
