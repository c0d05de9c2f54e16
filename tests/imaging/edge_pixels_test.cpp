#include "pipeline/imaging/edge_pixels.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "tests/imaging/rendered_edges.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/real_data.h"

namespace cgsr::imaging {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Canny with the same blur and gradient as ours, thresholds as ours.
cv::Mat canny(const cv::Mat& grey, const EdgeParameters& parameters) {
  cv::Mat blurred;
  cv::Mat words;
  grey.convertTo(words, CV_16S);
  const cv::Mat kernel = (cv::Mat_<float>(1, 3) << 1, 2, 1);
  cv::sepFilter2D(words, blurred, CV_16S, kernel, kernel);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(blurred, dx, CV_16S, 1, 0);
  cv::Sobel(blurred, dy, CV_16S, 0, 1);
  cv::Mat edges;
  cv::Canny(dx, dy, edges, parameters.min_contrast * EdgeDetector::kStepGain,
            parameters.min_strong_contrast * EdgeDetector::kStepGain, true);
  return edges;
}

cv::Mat picture_of(const EdgeDetector& detector, int width, int height) {
  cv::Mat picture(height, width, CV_8U, cv::Scalar(0));
  for (const EdgePixel& edge : detector.edges()) picture.at<std::uint8_t>(edge.y, edge.x) = 255;
  return picture;
}

/// Share of the pixels of `one` that have a pixel of `other` within one pixel, away from the border.
double share_found(const cv::Mat& one, const cv::Mat& other) {
  cv::Mat near_other;
  cv::dilate(other, near_other, cv::Mat::ones(3, 3, CV_8U));
  const cv::Rect inner(5, 5, one.cols - 10, one.rows - 10);
  const int all = cv::countNonZero(one(inner));
  cv::Mat both;
  cv::bitwise_and(one(inner), near_other(inner), both);
  return all == 0 ? 1.0 : static_cast<double>(cv::countNonZero(both)) / all;
}

void expect_as_canny(const cv::Mat& grey, double share, const std::string& what) {
  EdgeParameters parameters;
  parameters.noise_factor = 0.0;
  EdgeDetector detector(parameters, grey.cols, grey.rows);
  detector.find(grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step));
  const cv::Mat ours = picture_of(detector, grey.cols, grey.rows);
  const cv::Mat theirs = canny(grey, parameters);
  ASSERT_GT(cv::countNonZero(theirs), 100) << what;
  EXPECT_GE(share_found(theirs, ours), share) << what;
  EXPECT_GE(share_found(ours, theirs), share) << what;
}

TEST(EdgePixelsProperty, AreCannysOnDrawnImages) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 12; ++trial) {
    const int width = 160 + static_cast<int>(random() % 170);
    const int height = 120 + static_cast<int>(random() % 130);
    Bytes bytes = drawn::cluttered(random, width, height, 14).bytes(random, 0.7);
    expect_as_canny(cv::Mat(height, width, CV_8U, bytes.data()), 0.97, "trial " + std::to_string(trial));
  }
}

TEST(EdgePixelsProperty, AreCannysOnRealImages) {
  CGSR_NEEDS_REAL_DATA("localization/cube/img");
  int images = 0;
  for (const int number : {0, 40, 80}) {
    const auto file = test::real_data("localization/cube/img") / cv::format("image%04d.png", number);
    const cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    if (image.empty()) continue;
    cv::Mat half;
    cv::resize(image, half, {}, 0.5, 0.5, cv::INTER_AREA);
    expect_as_canny(half, 0.95, file.string());
    ++images;
  }
  EXPECT_GT(images, 0) << "CGSR_DATA does not lead to localization/cube";
}

TEST(EdgePixelsGolden, AStepLiesWhereItWasDrawn) {
  std::mt19937 random(2);
  for (const double blur : {0.4, 0.5, 0.8}) {
    double worst = 0.0;
    for (int twentieth = 0; twentieth < 20; ++twentieth) {
      const double x = 30.0 + 0.05 * twentieth;
      drawn::Canvas canvas(64, 48, 60.0);
      canvas.add_side({x, 0.0}, {1.0, 0.0}, 120.0, blur);
      const Bytes bytes = canvas.bytes(random, 0.0);
      EdgeDetector detector({}, 64, 48);
      const auto edges = detector.find(bytes.data(), 64, 48, 64);
      ASSERT_EQ(edges.size(), 48U - 2 * EdgeDetector::kBorder_px);
      for (const EdgePixel& edge : edges) {
        EXPECT_TRUE(edge.across_row());
        worst = std::max(worst, std::abs(static_cast<double>(edge.exact_x()) - x));
        EXPECT_GT(edge.gx, 0);
        EXPECT_EQ(edge.gy, 0);
      }
    }
    EXPECT_LT(worst, 0.06) << "blur " << blur;
  }
}

TEST(EdgePixelsGolden, SlopeOfASharpStep) {
  Bytes bytes(64 * 48, 50);
  for (std::size_t i = 64 * 24; i < bytes.size(); ++i) bytes[i] = 51 + 99;
  EdgeDetector detector({}, 64, 48);
  for (const EdgePixel& edge : detector.find(bytes.data(), 64, 48, 64)) {
    EXPECT_EQ(edge.gy, 100 * EdgeDetector::kStepGain);
    EXPECT_NEAR(static_cast<double>(edge.exact_y()), 23.5, 1e-6);
  }
  EXPECT_EQ(detector.edges().size(), 64U - 2 * EdgeDetector::kBorder_px);
}

TEST(EdgePixelsProperty, WeakOnesStayOnlyWithStrongOnes) {
  EdgeParameters parameters;
  parameters.min_contrast = 5.0;
  parameters.min_strong_contrast = 20.0;
  Bytes bytes(64 * 48, 100);
  for (std::size_t y = 0; y < 48; ++y) {
    for (std::size_t x = 20; x < 40; ++x)
      bytes[y * 64 + x] =
          static_cast<std::uint8_t>(100 + std::min<std::size_t>(y, 40));  // one border, stronger downwards
    for (std::size_t x = 52; x < 64; ++x) bytes[y * 64 + x] = 110;        // weak alone
  }
  EdgeDetector detector(parameters, 64, 48);
  bool weak_above = false;
  for (const EdgePixel& edge : detector.find(bytes.data(), 64, 48, 64)) {
    EXPECT_LT(edge.x, 45) << "a weak edge on its own";
    weak_above |= edge.y < 15;
  }
  EXPECT_TRUE(weak_above);
}

TEST(EdgePixelsProperty, TheMapLeadsToEveryPixelAndNowhereElse) {
  std::mt19937 random(3);
  EdgeDetector detector({}, 200, 160);
  for (int trial = 0; trial < 6; ++trial) {  // sizes change on one detector: nothing of an earlier image stays
    const int width = 40 + static_cast<int>(random() % 160);
    const int height = 40 + static_cast<int>(random() % 120);
    const Bytes bytes = drawn::cluttered(random, width, height, 8).bytes(random, 1.0);
    const auto edges = detector.find(bytes.data(), width, height, width);
    std::size_t in_map = 0;
    for (int i = 0; i < width * height; ++i) in_map += detector.map()[i] != 0 ? 1 : 0;
    EXPECT_EQ(in_map, edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      EXPECT_EQ(detector.map()[edges[i].y * width + edges[i].x], i + 1);
      EXPECT_GE(edges[i].x, EdgeDetector::kBorder_px);
      EXPECT_LT(edges[i].x, width - EdgeDetector::kBorder_px);
      EXPECT_GE(edges[i].y, EdgeDetector::kBorder_px);
      EXPECT_LT(edges[i].y, height - EdgeDetector::kBorder_px);
    }
  }
}

TEST(EdgePixelsProperty, NothingUnderTheMask) {
  std::mt19937 random(4);
  const Bytes bytes = drawn::cluttered(random, 160, 120, 12).bytes(random, 1.0);
  Bytes mask(bytes.size(), 0);
  for (std::size_t y = 60; y < 120; ++y)
    std::fill_n(mask.begin() + static_cast<std::ptrdiff_t>(y * 160 + 30), 100, std::uint8_t{1});
  EdgeDetector detector({}, 160, 120);
  const std::size_t all = detector.find(bytes.data(), 160, 120, 160).size();
  const auto edges = detector.find(bytes.data(), 160, 120, 160, mask.data());
  EXPECT_LT(edges.size(), all);
  EXPECT_FALSE(edges.empty());
  for (const EdgePixel& edge : edges) EXPECT_EQ(mask[static_cast<std::size_t>(edge.y * 160 + edge.x)], 0);
}

TEST(EdgePixelsProperty, NoiseIsMeasuredAndMakesNextToNoEdges) {
  std::mt19937 random(5);
  for (const double deviation : {1.0, 3.0, 8.0, 14.0}) {
    const Bytes bytes = drawn::Canvas(320, 240, 120.0).bytes(random, deviation);
    EdgeDetector detector({}, 320, 240);
    const auto edges = detector.find(bytes.data(), 320, 240, 320);
    EXPECT_NEAR(detector.noise(), deviation, 0.15 * deviation + 0.15);
    EXPECT_LT(edges.size(), 60U) << deviation;
  }
}

TEST(EdgePixelsFault, SizesThatItIsNotMadeFor) {
  const Bytes bytes(64 * 64, 0);
  EdgeDetector detector({}, 48, 32);
  EXPECT_TRUE(detector.find(bytes.data(), 64, 16, 64).empty());
  EXPECT_TRUE(detector.find(bytes.data(), 48, 64, 64).empty());
  EXPECT_TRUE(detector.find(bytes.data(), 15, 32, 64).empty());
}

TEST(EdgePixelsFault, MoreEdgesThanThereIsRoomFor) {
  std::mt19937 random(6);
  Bytes bytes(64 * 48);
  for (auto& byte : bytes) byte = random() % 2 == 0 ? 0 : 255;
  EdgeParameters parameters;
  parameters.min_contrast = 1.0;
  parameters.min_strong_contrast = 1.0;
  parameters.noise_factor = 0.0;
  EdgeDetector detector(parameters, 64, 48);
  EXPECT_LE(detector.find(bytes.data(), 64, 48, 64).size(), detector.capacity());
}

TEST(EdgePixelsAlloc, NothingAfterConstruction) {
  if (!cgsr::test::AllocationGuard::counts()) GTEST_SKIP() << "SKIPPED: allocations are not counted in this build";
  std::mt19937 random(7);
  const Bytes bytes = drawn::cluttered(random, 320, 240, 30).bytes(random, 1.0);
  EdgeDetector detector({}, 320, 240);
  const cgsr::test::AllocationGuard guard;
  detector.find(bytes.data(), 320, 240, 320);
  detector.find(bytes.data(), 160, 120, 320);
  EXPECT_EQ(guard.allocations(), 0U);
}

}  // namespace
}  // namespace cgsr::imaging
