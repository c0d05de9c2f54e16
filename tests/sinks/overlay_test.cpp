#include "src/output/overlay.h"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::app {
namespace {

/// Whether some pixel of the picture has this colour, B G R, within a unit.
bool shows(const cv::Mat& picture, const cv::Vec3b& wanted) {
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      if (cv::norm(cv::Vec3d(picture.at<cv::Vec3b>(y, x)) - cv::Vec3d(wanted), cv::NORM_INF) <= 1.0) return true;
    }
  }
  return false;
}

TEST(Overlay, TheStripeShowsTheFollowedLightAndThePlurality) {
  const std::vector<std::uint8_t> black(64 * 48, 16);
  ImageView image;
  image.data = black.data();
  image.width_px = 64;
  image.height_px = 48;
  image.stride_bytes = 64;
  image.format = PixelFormat::kGrey8;
  const cv::Vec3b orange(51, 128, 255);
  const cv::Vec3b green(51, 204, 102);

  Overlay overlay(64, 48);
  OverlayFacts facts;
  EXPECT_FALSE(shows(overlay.draw(image, facts), orange));
  facts.box = Box{10, 10, 20, 20};
  facts.light = color::Light{1.0, 0.5, 0.2};
  facts.plurality = color::Light{0.4, 0.8, 0.2};
  const cv::Mat& picture = overlay.draw(image, facts);
  EXPECT_TRUE(shows(picture, orange));
  EXPECT_TRUE(shows(picture, green));
}

}  // namespace
}  // namespace cgsr::app
