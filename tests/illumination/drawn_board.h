#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
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
  double board_level = 140.0;
  double shadow_level = 30.0;  ///< how much darker.
  double cone_level = 90.0;
  double room_level = 60.0;
  double noise = 1.0;
  bool right_cone = true;
  std::uint32_t seed = 1;
  /// Darkens places of the board for any other reason.
  std::function<double(const Eigen::Vector2d&)> darker = [](const Eigen::Vector2d&) { return 0.0; };
};

inline constexpr int kFirstRowOfInterest = 262;  // above it the shipped camera sees neither board nor cone

/// Draws by casting nine rays a pixel: slow, plain, and without the pipeline's projection.
inline DrawnImage draw(const Board& board, const geometry::Pose& X_BC, const Drawing& drawing) {
  DrawnImage image{board.camera.width_px, board.camera.height_px, {}};
  image.grey.resize(static_cast<std::size_t>(image.width_px * image.height_px));
  std::mt19937 random(drawing.seed);
  const int cones = drawing.right_cone ? 2 : 1;
  const auto cone_covers = [&](const Eigen::Vector3d& from, const Eigen::Vector2d& p_B) {
    for (int i = 0; i < cones; ++i) {
      const Probe& probe = board.probe[static_cast<std::size_t>(i)];
      const auto outline = outline_of(probe.foot_B, probe.radius_m, cast(from, probe.p_BA));
      if (within(outline, probe.foot_B, probe.radius_m, p_B, 0.0)) return true;
    }
    return false;
  };
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      double sum = 0.0;
      const int rays = y < kFirstRowOfInterest ? 0 : 9;
      if (rays == 0) sum = drawing.room_level;
      for (int sub = 0; sub < rays; ++sub) {
        const Eigen::Vector2d pixel(x + (sub % 3 - 1) / 3.0, y + (sub / 3 - 1) / 3.0);
        const Eigen::Vector2d ideal = board.camera.ideal_of(pixel);
        const Eigen::Vector3d ray = X_BC.linear() * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
        double value = drawing.room_level;
        if (ray.z() < -1e-6) {
          const Eigen::Vector3d meets = X_BC.translation() - ray * (X_BC.translation().z() / ray.z());
          const Eigen::Vector2d p_B = meets.head<2>();
          const bool on_board = std::abs(p_B.x()) < board.depth_m / 2 && std::abs(p_B.y()) < board.width_m / 2;
          if (cone_covers(X_BC.translation(), p_B)) {
            value = drawing.cone_level;
          } else if (on_board) {
            value = drawing.board_level - drawing.darker(p_B);
            for (const auto& lamp : drawing.lamps_B) value -= cone_covers(lamp, p_B) ? drawing.shadow_level : 0.0;
          }
        }
        sum += value / 9.0;
      }
      double noise = -6.0;
      for (int i = 0; i < 12; ++i) noise += random() / 4294967296.0;
      const double level = std::clamp(sum + drawing.noise * noise, 0.0, 255.0);
      image.grey[static_cast<std::size_t>(y * image.width_px + x)] = static_cast<std::uint8_t>(std::lround(level));
    }
  }
  return image;
}

/// A lamp above the board from where light comes at an angle from the vertical.
inline Eigen::Vector3d lamp_at(double angle_deg, double around_deg, double height_m = 1.85) {
  const double flat = height_m * std::tan(angle_deg * M_PI / 180.0);
  return {flat * std::cos(around_deg * M_PI / 180.0), flat * std::sin(around_deg * M_PI / 180.0), height_m};
}

}  // namespace cgsr::illumination
