#include "pipeline/calibration/intrinsics.h"

#include <gtest/gtest.h>

#include "tests/calibration/board_pictures.h"

namespace cgsr::calibration {
namespace {

const Board kBoard{9, 6, 0.025};
const cv::Size kSize(640, 480);

/// Views of a board all over the image, corners off by N(0, noise) px.
std::vector<BoardView> views_of(std::mt19937& random, int count, double noise, double left = 0.2, double right = 0.8) {
  std::vector<BoardView> views;
  const geometry::Camera camera = testing::true_camera();
  while (static_cast<int>(views.size()) < count) {
    const double far = testing::uniform(random, 0.3, 0.6);
    const auto X_CB = testing::board_before_camera(random, kBoard, camera, testing::uniform(random, left, right),
                                                   testing::uniform(random, 0.2, 0.8), far);
    auto corners = testing::corners_of(X_CB, kBoard, camera);
    if (corners.empty()) continue;
    for (cv::Point2f& corner : corners) {
      corner.x += static_cast<float>(noise * testing::normal(random));
      corner.y += static_cast<float>(noise * testing::normal(random));
    }
    views.push_back({static_cast<int>(views.size()), std::move(corners)});
  }
  return views;
}

TEST(IntrinsicsGolden, TheTrueCameraComesBack) {
  std::mt19937 random(1);
  const auto result = calibrate_intrinsics(views_of(random, 25, 0.1), kBoard, kSize);
  ASSERT_TRUE(result) << result.error().message;
  const geometry::Camera truth = testing::true_camera();
  const geometry::Camera& camera = result->camera;
  EXPECT_NEAR(camera.fx_px, truth.fx_px, 0.002 * truth.fx_px);
  EXPECT_NEAR(camera.fy_px, truth.fy_px, 0.002 * truth.fy_px);
  EXPECT_NEAR(camera.cx_px, truth.cx_px, 1.5);
  EXPECT_NEAR(camera.cy_px, truth.cy_px, 1.5);
  EXPECT_NEAR(camera.k1, truth.k1, 0.01);
  EXPECT_LT(std::abs(camera.fx_px - truth.fx_px), 4.0 * result->sigma.fx_px);
  EXPECT_GT(result->sigma.fx_px, 0.01);
  EXPECT_NEAR(result->rms_px, 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_EQ(camera.width_px, 640);
  EXPECT_EQ(camera.height_px, 480);
}

TEST(IntrinsicsFault, AViewThatIsWrongIsLeftOut) {
  std::mt19937 random(2);
  auto views = views_of(random, 15, 0.1);
  for (cv::Point2f& corner : views[4].corners)
    corner += cv::Point2f(static_cast<float>(testing::normal(random)), static_cast<float>(testing::normal(random)));
  const auto result = calibrate_intrinsics(views, kBoard, kSize);
  ASSERT_TRUE(result) << result.error().message;
  for (std::size_t i = 0; i < views.size(); ++i) EXPECT_EQ(result->used[i], i != 4);
  EXPECT_GT(result->view_rms_px[4], 0.8);
}

TEST(IntrinsicsFault, RefusedWithTheReason) {
  std::mt19937 random(3);
  const auto reason = [](const std::vector<BoardView>& views) {
    const auto result = calibrate_intrinsics(views, kBoard, kSize);
    return result ? std::string() : result.error().message;
  };
  EXPECT_NE(reason(views_of(random, 5, 0.1)).find("in 5 views; expected at least 8"), std::string::npos);
  EXPECT_NE(reason({}).find("in 0 views"), std::string::npos);
  EXPECT_NE(reason(views_of(random, 12, 0.1, 0.2, 0.25)).find("right"), std::string::npos);
  EXPECT_NE(reason(views_of(random, 20, 3.0)).find("px (RMS) off"), std::string::npos);
  // One view, again and again.
  std::vector<BoardView> same;
  const geometry::Camera camera = testing::true_camera();
  for (int i = 0; i < 12; ++i) {
    geometry::Pose X_CB = geometry::Pose::Identity();  // straight from the front, filling the image
    X_CB.translation() = Eigen::Vector3d(-0.1, -0.0625, 0.24 + 0.001 * i);
    auto corners = testing::corners_of(X_CB, kBoard, camera);
    ASSERT_FALSE(corners.empty());
    for (cv::Point2f& corner : corners) corner.x += static_cast<float>(0.2 * testing::normal(random));
    same.push_back({i, std::move(corners)});
  }
  EXPECT_NE(reason(same).find("tilt the board"), std::string::npos) << reason(same);
}

}  // namespace
}  // namespace cgsr::calibration
