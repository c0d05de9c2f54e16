#include "pipeline/color/search/window_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace cgsr::color {
namespace {

imaging::ReducedImage image_of(int width_px, int height_px, int factor) {
  imaging::ReducedImage image(16, 16);
  image.factor = factor;
  image.width_px = width_px / factor;
  image.height_px = height_px / factor;
  return image;
}

SearchRequest request_for(double width_px, double height_px) {
  SearchRequest request;
  request.width_px = width_px;
  request.height_px = height_px;
  return request;
}

TEST(WindowGrid, ACanInATypicalImage) {
  const auto grid = window_grid({}, image_of(640, 480, 2), request_for(48, 80));
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->cell_px, 3);  // 48 / 8 = 6 camera pixels
  EXPECT_EQ(grid->right, 106);
  EXPECT_EQ(grid->bottom, 80);
  ASSERT_EQ(grid->size_count, 3);
  EXPECT_EQ(grid->sizes[1].width, 8);
  EXPECT_EQ(grid->sizes[1].height, 13);
  EXPECT_EQ(grid->pixels(1), 8 * 13 * 9);
  EXPECT_EQ(grid->columns(1), 99);
  EXPECT_EQ(grid->box({2, 3, 1}), (Box{12, 18, 48, 78}));
}

// The promise about the stride, and windows that are never off by more than half a cell and never outside.
TEST(WindowGridProperty, StrideSizesAndPlacesAreAsPromised) {
  std::mt19937 random(41);
  for (int trial = 0; trial < 5000; ++trial) {
    const int factor = 1 + static_cast<int>(random() % 2);
    const int width = 16 + 2 * static_cast<int>(random() % 400), height = 16 + static_cast<int>(random() % 600);
    SearchRequest request = request_for(4 + random() % 300, 4 + random() % 300);
    if (random() % 2 == 0)
      request.region = Box{random() % 400 - 50.0, random() % 400 - 50.0, random() % 400 + 0.5, random() % 400 + 0.25};
    SearchParameters parameters;
    parameters.sizes = 1 + static_cast<int>(random() % 5);
    const auto image = image_of(width, height, factor);
    const auto grid = window_grid(parameters, image, request);
    if (!grid) {
      ASSERT_EQ(grid.error(), SearchFailure::kNoRoom);
      continue;
    }
    const double stride_px = grid->cell_px * factor;
    const double shorter = std::min(request.width_px, request.height_px);
    ASSERT_TRUE(stride_px <= 8.0 && (stride_px <= shorter / 8 || grid->cell_px == 1)) << trial;
    for (int size = 0; size < grid->size_count; ++size) {
      ASSERT_LE(grid->pixels(size), kMaxWindowPixels);
      const Box first = grid->box({grid->left, grid->top, size});
      const Box last = grid->box({grid->left + grid->columns(size) - 1, grid->top + grid->rows(size) - 1, size});
      ASSERT_GE(grid->columns(size), 1);
      ASSERT_GE(grid->rows(size), 1);
      ASSERT_LE(last.x + last.width, image.width_px * factor);
      ASSERT_LE(last.y + last.height, image.height_px * factor);
      if (request.region) {
        ASSERT_GE(first.x, request.region->x);
        ASSERT_GE(first.y, request.region->y);
        ASSERT_LE(last.x + last.width, request.region->x + request.region->width);
        ASSERT_LE(last.y + last.height, request.region->y + request.region->height);
      }
      if (size > 0) {
        const Box before = grid->box({0, 0, size - 1});
        ASSERT_TRUE(before.width <= first.width && before.height <= first.height && before.area() < first.area());
      }
    }
  }
}

TEST(WindowGrid, HowMuchTwoWindowsCollide) {
  const auto grid = window_grid({}, image_of(640, 480, 2), request_for(48, 80));
  const int w = grid->sizes[1].width, h = grid->sizes[1].height;
  const GridWindow a{10, 10, 1};
  EXPECT_FALSE(grid->collide(a, {10 + w, 10, 1}, 0.0));
  EXPECT_FALSE(grid->collide(a, {10, 10 + h, 1}, 0.0));
  EXPECT_TRUE(grid->collide(a, {10 + w - 1, 10 + h - 1, 1}, 0.0));
  EXPECT_FALSE(grid->collide(a, {10 + w / 2, 10, 1}, 0.5));
  EXPECT_TRUE(grid->collide(a, {10 + w / 2 - 1, 10, 1}, 0.5));
  EXPECT_TRUE(grid->collide(a, {10, 10, 0}, 0.9));  // the smaller one inside the larger
}

TEST(WindowGridFault, RefusesQuestionsThatMeanNothing) {
  const auto image = image_of(640, 480, 2);
  const auto failure = [&](auto change) {
    SearchRequest request = request_for(48, 80);
    change(request);
    const auto grid = window_grid({}, image, request);
    return grid ? std::optional<SearchFailure>{} : grid.error();
  };
  const double nan = std::nan("");
  using R = SearchRequest;
  EXPECT_EQ(failure([](R&) {}), std::nullopt);
  EXPECT_EQ(failure([](R& r) { r.width_px = 0; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([&](R& r) { r.height_px = nan; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([&](R& r) { r.max_divergence = nan; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([](R& r) { r.candidates = 0; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([](R& r) { r.candidates = kMaxMatches + 1; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([](R& r) { r.max_overlap = 1.5; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([](R& r) { r.max_shortfall = -0.1; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([&](R& r) { r.region = Box{0, nan, 100, 100}; }), SearchFailure::kBadRequest);
  EXPECT_EQ(failure([](R& r) { r.region = Box{0, 0, 20, 20}; }), SearchFailure::kNoRoom);
  EXPECT_EQ(failure([](R& r) { r.width_px = 900; }), SearchFailure::kNoRoom);
}

}  // namespace
}  // namespace cgsr::color
