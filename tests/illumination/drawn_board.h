#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/illumination/probe_observation.h"

namespace cgsr::illumination {

/// The shipped geometry: a level board 0.9 m above the floor, the camera 0.3 m above it and tilted 20 degrees down.
inline geometry::Pose shipped_mount() {
  geometry::Pose X_RC = geometry::Pose::Identity();
  const double s = std::sin(20.0 * M_PI / 180.0);
  const double c = std::cos(20.0 * M_PI / 180.0);
  X_RC.linear().col(0) = Eigen::Vector3d(0.0, -1.0, 0.0);
  X_RC.linear().col(1) = Eigen::Vector3d(-s, 0.0, -c);
  X_RC.linear().col(2) = Eigen::Vector3d(c, 0.0, -s);
  X_RC.translation() = Eigen::Vector3d(0.0, 0.0, 1.2);
  return X_RC;
}

inline geometry::Camera shipped_camera() {
  geometry::Camera camera;
  camera.k1 = -0.075;
  camera.k2 = 0.045;
  camera.p1 = 0.0006;
  camera.p2 = -0.0004;
  return camera;
}

inline ProbesParameters shipped_probes() {
  ProbesParameters parameters;
  parameters.board.probes = 2;
  return parameters;
}

inline Board shipped_board() {
  auto board = make_board(shipped_probes().board, shipped_mount(), shipped_camera());
  EXPECT_TRUE(board) << board.error().message;
  return *board;
}

/// A grey image.
struct DrawnImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> grey;
  [[nodiscard]] ImageView view() const { return {grey.data(), width_px, height_px, width_px, PixelFormat::kGrey8}; }
};

/// What is drawn beside board and cones.
struct Drawing {
  std::vector<Eigen::Vector3d> lamps_B;  ///< point lamps, board's frame.
  double board_level = 140.0;            ///< above 255: the image holds less.
  double shadow_level = 30.0;            ///< how much darker, where all of a lamp is hidden.
  int lamp_parts =
      1;  ///< so many of lamps_B are one lamp: each takes its share of the light, which the camera codes as sRGB.
  double cone_level = 90.0;
  double room_level = 60.0;
  double noise = 1.0;
  bool right_cone = true;
  std::uint32_t seed = 1;
  /// Darkens places of the board for any other reason.
  std::function<double(const Eigen::Vector2d&)> darker = [](const Eigen::Vector2d&) { return 0.0; };
};

/// A lamp that is a ball: a disc of points.
inline void shine_from_ball(const Eigen::Vector3d& p_BL, double shadow_level, Drawing& drawing, double radius_m = 0.05,
                            int parts = 9) {
  drawing.shadow_level = shadow_level;
  drawing.lamp_parts = parts;
  for (int i = 0; i < parts; ++i) {
    const double radius = radius_m * std::sqrt((i + 0.5) / parts);
    const double angle = 2.4 * i;
    drawing.lamps_B.emplace_back(p_BL + radius * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
  }
}

/// Draws by casting nine rays a pixel: plain, and without the pipeline's projection. Threads: one at a time, it keeps the camera's rays.
DrawnImage draw(const Board& board, const geometry::Pose& X_BC, const Drawing& drawing);

/// A lamp above the board from where light comes at an angle from the vertical.
inline Eigen::Vector3d lamp_at(double angle_deg, double around_deg, double height_m = 1.85) {
  const double flat = height_m * std::tan(angle_deg * M_PI / 180.0);
  return {flat * std::cos(around_deg * M_PI / 180.0), flat * std::sin(around_deg * M_PI / 180.0), height_m};
}

}  // namespace cgsr::illumination
