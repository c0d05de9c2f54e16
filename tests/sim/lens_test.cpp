#include "hal/sim/render/lens.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

cv::Matx33d matrix(const CameraModel& c) {
  return {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1};
}

cv::Mat distortion(const CameraModel& c) {
  return (cv::Mat_<double>(1, 5) << c.k1, c.k2, c.p1, c.p2, c.k3);
}

TEST(LensProperty, UnprojectingIsTheInverseOfProjecting) {
  const CameraModel camera;
  Seeded random(7);
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector2d pixel(random.uniform(-20, 660), random.uniform(-20, 500));
    EXPECT_LT((project(camera, unproject(camera, pixel)) - pixel).norm(), 1e-9);
  }
}

TEST(LensProperty, IsBrownsModelAsOpenCvWritesIt) {
  const CameraModel camera;
  Seeded random(8);
  for (int trial = 0; trial < 500; ++trial) {
    const Eigen::Vector2d xy(random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4));
    std::vector<cv::Point2d> out;
    cv::projectPoints(std::vector<cv::Point3d>{{xy.x(), xy.y(), 1.0}}, cv::Vec3d(), cv::Vec3d(), matrix(camera),
                      distortion(camera), out);
    const Eigen::Vector2d ours = project(camera, xy);
    EXPECT_NEAR(ours.x(), out[0].x, 1e-9);
    EXPECT_NEAR(ours.y(), out[0].y, 1e-9);
  }
}

// A board of 10 x 8 squares of 30 mm, drawn; and its 9 x 7 inner corners.
struct Chessboard {
  Scene scene = dark_scene();
  std::vector<cv::Point3f> corners;

  Chessboard() {
    Material squares;
    squares.pattern = PatternKind::kChecker;
    squares.size_m = 0.03F;
    squares.albedo = Rgb::Constant(0.04F);
    squares.second_albedo = Rgb::Constant(0.85F);
    scene.add_static("paper", make_rectangle(0.36, 0.30), matt(scene, Rgb::Constant(0.85F)), pose_at({0, 0, -0.0002}));
    scene.add_static("board", make_rectangle(0.30, 0.24), scene.add_material(squares));
    scene.ambient.illuminance_lux = Rgb::Constant(100);
    for (int row = 0; row < 7; ++row) {
      for (int column = 0; column < 9; ++column) corners.emplace_back(0.03F * (column - 4), 0.03F * (row - 3), 0.0F);
    }
  }
};

cv::Mat grey_of(const RadianceImage& image) {
  cv::Mat grey(image.height_px, image.width_px, CV_8U);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x)
      grey.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(image.at(x, y)[1] * 8.5F);
  }
  // As optics would: cornerSubPix interpolates between pixels, and finds corners only to 0.1 px where edges are sharper than a pixel.
  cv::GaussianBlur(grey, grey, {7, 7}, 1.0);
  return grey;
}

std::vector<cv::Point2f> analytic(const Chessboard& board, const CameraModel& camera, const Pose& X_WC) {
  std::vector<cv::Point2f> points;
  for (const cv::Point3f& corner : board.corners) {
    const Eigen::Vector3d p_C = X_WC.inverse() * Eigen::Vector3d(corner.x, corner.y, corner.z);
    std::vector<cv::Point2d> out;
    cv::projectPoints(std::vector<cv::Point3d>{{p_C.x(), p_C.y(), p_C.z()}}, cv::Vec3d(), cv::Vec3d(), matrix(camera),
                      distortion(camera), out);
    points.emplace_back(out[0]);
  }
  return points;
}

// Corner by corner against the analytic projection, then the whole through OpenCV's calibration, as one does with a real camera.
TEST(LensCalibration, OpenCvFindsTheTrueCameraInRenderedChessboards) {
  const Chessboard board;
  const CameraModel camera;
  const auto renderer = renderer_for(board.scene, camera, 16);
  std::vector<std::vector<cv::Point2f>> seen;
  std::vector<std::vector<cv::Point3f>> model;
  Seeded random(5);
  double worst_px = 0.0;
  for (int trial = 0; trial < 60 && seen.size() < 14; ++trial) {
    // Tilted views from near, aimed so that the board lies now here, now there in the image.
    const double tilt = degrees(random.uniform(15, 42));
    const double around = random.uniform(0, 2 * kPi);
    const double distance = random.uniform(0.36, 0.52);
    const Eigen::Vector3d from(distance * sine(tilt) * cosine(around), distance * sine(tilt) * sine(around),
                               distance * cosine(tilt));
    const Pose X_WC = look_at(from, {random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), 0});
    const std::vector<cv::Point2f> truth = analytic(board, camera, X_WC);
    const cv::Rect2f box = cv::boundingRect(truth);
    if (box.x < 18 || box.y < 18 || box.br().x > 622 || box.br().y > 462) continue;

    RadianceImage image;
    renderer->draw(state_at(board.scene, 0.0), X_WC, image);
    std::vector<cv::Point2f> corners = truth;  // refined from a pixel off: finding the board is not the question here
    for (std::size_t i = 0; i < corners.size(); ++i)
      corners[i] += cv::Point2f(i % 2 == 0 ? 0.8F : -0.8F, i % 3 == 0 ? -0.7F : 0.7F);
    cv::cornerSubPix(grey_of(image), corners, {5, 5}, {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4});
    for (std::size_t i = 0; i < corners.size(); ++i) worst_px = std::max(worst_px, cv::norm(corners[i] - truth[i]));
    seen.push_back(corners);
    model.push_back(board.corners);
  }
  ASSERT_EQ(seen.size(), 14U);
  EXPECT_LT(worst_px, 0.1);

  cv::Mat K;
  cv::Mat d;
  std::vector<cv::Mat> r;
  std::vector<cv::Mat> t;
  const double rms = cv::calibrateCamera(model, seen, {640, 480}, K, d, r, t, cv::CALIB_FIX_K3);
  EXPECT_LT(rms, 0.05);
  EXPECT_NEAR(K.at<double>(0, 0) / camera.fx_px, 1.0, 0.002);
  EXPECT_NEAR(K.at<double>(1, 1) / camera.fy_px, 1.0, 0.002);
  EXPECT_NEAR(K.at<double>(0, 2), camera.cx_px, 0.002 * 640);
  EXPECT_NEAR(K.at<double>(1, 2), camera.cy_px, 0.002 * 480);
  // The distortion as it moves points: anywhere in the image, and against how far it moves them in a corner.
  double off_px = 0.0;
  double most_px = 0.0;
  for (double y = -0.38; y <= 0.38; y += 0.04) {
    for (double x = -0.5; x <= 0.5; x += 0.04) {
      std::vector<cv::Point2d> ours;
      std::vector<cv::Point2d> found;
      std::vector<cv::Point2d> straight;
      const std::vector<cv::Point3d> point{{x, y, 1.0}};
      cv::projectPoints(point, cv::Vec3d(), cv::Vec3d(), matrix(camera), distortion(camera), ours);
      cv::projectPoints(point, cv::Vec3d(), cv::Vec3d(), matrix(camera), d, found);
      cv::projectPoints(point, cv::Vec3d(), cv::Vec3d(), matrix(camera), cv::noArray(), straight);
      off_px = std::max(off_px, cv::norm(ours[0] - found[0]));
      most_px = std::max(most_px, cv::norm(ours[0] - straight[0]));
    }
  }
  EXPECT_LT(off_px, 0.2) << "of up to 8.9 px that the lens moves points";
  EXPECT_GT(most_px, 5.0) << "the lens does distort";
  RecordProperty("worst_corner_px", std::to_string(worst_px));
  RecordProperty("distortion_off_px", std::to_string(off_px));
  std::printf(
      "corners within %.3f px, rms %.3f px, fx %.5f fy %.5f (ratio to the truth), distortion within %.3f px of up to "
      "%.1f\n",
      worst_px, rms, K.at<double>(0, 0) / camera.fx_px, K.at<double>(1, 1) / camera.fy_px, off_px, most_px);
}

}  // namespace
}  // namespace cgsr::sim
