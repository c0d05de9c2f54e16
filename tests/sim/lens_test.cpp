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

// A board of 24 x 18 squares of 30 mm, larger than the view, so that corners lie everywhere in the image; and its inner corners.
struct Chessboard {
  static constexpr int kColumns = 24;
  static constexpr int kRows = 18;
  Scene scene = dark_scene();
  std::vector<cv::Point3f> corners;

  Chessboard() {
    Material squares;
    squares.pattern = PatternKind::kChecker;
    squares.size_m = 0.03F;
    squares.albedo = Rgb::Constant(0.04F);
    squares.second_albedo = Rgb::Constant(0.85F);
    scene.add_static("board", make_rectangle(0.03 * kColumns, 0.03 * kRows), scene.add_material(squares));
    scene.ambient.illuminance_lux = Rgb::Constant(100);
    for (int row = 1; row < kRows; ++row) {
      for (int column = 1; column < kColumns; ++column) {
        corners.emplace_back(0.03F * static_cast<float>(column - kColumns / 2),
                             0.03F * static_cast<float>(row - kRows / 2), 0.0F);
      }
    }
  }
};

cv::Mat grey_of(const RadianceImage& image) {
  cv::Mat grey(image.height_px, image.width_px, CV_32F);
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) grey.at<float>(y, x) = image.at(x, y)[1];
  }
  // As optics would: cornerSubPix interpolates between pixels, and finds corners only to 0.1 px where edges are sharper than a pixel.
  cv::GaussianBlur(grey, grey, {7, 7}, 1.0);
  return grey;
}

// One view of the board: the corners that lie well inside the image, where they should be and where they are seen.
struct View {
  std::vector<cv::Point3f> model;
  std::vector<cv::Point2f> truth;
  std::vector<cv::Point2f> seen;
};

View look_at_board(const Chessboard& board, Renderer& renderer, const Pose& X_WC) {
  const CameraModel& camera = renderer.camera();
  View view;
  for (const cv::Point3f& corner : board.corners) {
    const Eigen::Vector3d p_C = X_WC.inverse() * Eigen::Vector3d(corner.x, corner.y, corner.z);
    const Eigen::Vector2d xy = p_C.head<2>() / p_C.z();
    if (p_C.z() < 0.05 || xy.cwiseAbs().maxCoeff() > 0.7) continue;
    std::vector<cv::Point2d> out;
    cv::projectPoints(std::vector<cv::Point3d>{{xy.x(), xy.y(), 1.0}}, cv::Vec3d(), cv::Vec3d(), matrix(camera),
                      distortion(camera), out);
    if (out[0].x < 9 || out[0].y < 9 || out[0].x > camera.width_px - 10 || out[0].y > camera.height_px - 10) continue;
    view.model.push_back(corner);
    view.truth.emplace_back(out[0]);
  }
  RadianceImage image;
  renderer.draw(state_at(board.scene, 0.0), X_WC, image);
  view.seen = view.truth;  // refined from a pixel off: finding the board is not the question here
  for (std::size_t i = 0; i < view.seen.size(); ++i)
    view.seen[i] += cv::Point2f(i % 2 == 0 ? 0.8F : -0.8F, i % 3 == 0 ? -0.7F : 0.7F);
  cv::cornerSubPix(grey_of(image), view.seen, {5, 5}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-4});
  return view;
}

/// How far a calibrated distortion moves points otherwise than the camera's own, at most, and how far that moves them.
struct DistortionError {
  double off_px = 0.0;
  double most_px = 0.0;
};

DistortionError distortion_error(const CameraModel& camera, const cv::Mat& found_distortion) {
  DistortionError error;
  for (double y = -0.38; y <= 0.38; y += 0.04) {
    for (double x = -0.5; x <= 0.5; x += 0.04) {
      const auto projected = [&](const auto& with) {
        std::vector<cv::Point2d> points;
        cv::projectPoints(std::vector<cv::Point3d>{{x, y, 1.0}}, cv::Vec3d(), cv::Vec3d(), matrix(camera), with,
                          points);
        return points[0];
      };
      const cv::Point2d ours = projected(distortion(camera));
      error.off_px = std::max(error.off_px, cv::norm(ours - projected(found_distortion)));
      error.most_px = std::max(error.most_px, cv::norm(ours - projected(cv::Mat())));
    }
  }
  return error;
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
  std::size_t count = 0;
  for (int trial = 0; trial < 16; ++trial) {  // tilted views from near
    const double tilt = degrees(random.uniform(12, 38));
    const double around = random.uniform(0, 2 * kPi);
    const double distance = random.uniform(0.36, 0.52);
    const Eigen::Vector3d from(distance * sine(tilt) * cosine(around), distance * sine(tilt) * sine(around),
                               distance * cosine(tilt));
    const View view =
        look_at_board(board, *renderer, look_at(from, {random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0}));
    for (std::size_t i = 0; i < view.seen.size(); ++i)
      worst_px = std::max(worst_px, cv::norm(view.seen[i] - view.truth[i]));
    count += view.seen.size();
    seen.push_back(view.seen);
    model.push_back(view.model);
  }
  ASSERT_GT(count, 1500U);
  EXPECT_LT(worst_px, 0.1);

  cv::Mat K;
  cv::Mat d;
  std::vector<cv::Mat> r;
  std::vector<cv::Mat> t;
  const double rms = cv::calibrateCamera(model, seen, {640, 480}, K, d, r, t, cv::CALIB_FIX_K3);
  EXPECT_LT(rms, 0.05);
  EXPECT_NEAR(K.at<double>(0, 0) / camera.fx_px, 1.0, 0.002);
  EXPECT_NEAR(K.at<double>(1, 1) / camera.fy_px, 1.0, 0.002);
  EXPECT_NEAR(K.at<double>(0, 2) / camera.cx_px, 1.0, 0.002);
  EXPECT_NEAR(K.at<double>(1, 2) / camera.cy_px, 1.0, 0.002);
  EXPECT_NEAR(d.at<double>(0) / camera.k1, 1.0, 0.002);
  // The distortion as it moves points: anywhere in the image, and against how far it moves them in a corner.
  const auto [off_px, most_px] = distortion_error(camera, d);
  EXPECT_LT(off_px, 0.002 * most_px) << "of the way that the lens moves points";
  EXPECT_GT(most_px, 5.0) << "the lens does distort";
  RecordProperty("worst_corner_px", std::to_string(worst_px));
  RecordProperty("distortion_off_px", std::to_string(off_px));
  std::printf(
      "%zu corners within %.3f px, rms %.3f px, fx %.5f fy %.5f cx %.5f cy %.5f k1 %.5f (ratio to the truth), "
      "distortion "
      "within %.4f px of up to %.1f\n",
      count, worst_px, rms, K.at<double>(0, 0) / camera.fx_px, K.at<double>(1, 1) / camera.fy_px,
      K.at<double>(0, 2) / camera.cx_px, K.at<double>(1, 2) / camera.cy_px, d.at<double>(0) / camera.k1, off_px,
      most_px);
}

}  // namespace
}  // namespace cgsr::sim
