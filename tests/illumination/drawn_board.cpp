#include "tests/illumination/drawn_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <tuple>

namespace cgsr::illumination {
namespace {

constexpr int kFirstRowOfInterest = 262;  // above it the shipped camera sees neither board nor cone
constexpr int kSide = 3;                  // rays of a pixel across and down
constexpr int kRays = kSide * kSide;

constexpr double kZero = -0.055 * 255.0;  // of the sRGB transfer function, as levels

double light_of(double level) {
  return std::pow(std::max(0.0, level - kZero), 2.4);
}
double level_of(double light) {
  return kZero + std::pow(std::max(0.0, light), 1.0 / 2.4);
}

auto lens_of(const geometry::Camera& c) {
  return std::make_tuple(c.width_px, c.height_px, c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.k1, c.k2, c.p1, c.p2, c.k3);
}

// Ideal coordinates of nine points of each pixel, from the first row of interest on. All images of a test are of one camera.
const std::vector<Eigen::Vector2d>& rays_of(const geometry::Camera& camera) {
  static geometry::Camera known;
  static std::vector<Eigen::Vector2d> rays;
  if (!rays.empty() && lens_of(camera) == lens_of(known)) return rays;
  known = camera;
  rays.clear();
  for (int y = kFirstRowOfInterest; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      for (int sub = 0; sub < kRays; ++sub) {
        const int row = sub / kSide;
        rays.push_back(camera.ideal_of({x + (sub % kSide - 1) / 3.0, y + (row - 1) / 3.0}));
      }
    }
  }
  return rays;
}

// What the cones hide from a place, or keep the light of it from.
class Hidden {
 public:
  Hidden(const Board& board, std::size_t cones, const Eigen::Vector3d& from) : board_(board), cones_(cones) {
    for (std::size_t i = 0; i < cones_; ++i) {
      const Probe& probe = board.probe[i];
      outline_[i] = outline_of(probe.foot_B, probe.radius_m, cast(from, probe.p_BA));
    }
  }
  [[nodiscard]] bool has(const Eigen::Vector2d& p_B) const {
    for (std::size_t i = 0; i < cones_; ++i) {
      const Probe& probe = board_.probe[i];
      if (within(outline_[i], probe.foot_B, probe.radius_m, p_B, 0.0)) return true;
    }
    return false;
  }

 private:
  const Board& board_;
  std::size_t cones_;
  std::array<Outline, 2> outline_;
};

}  // namespace

DrawnImage draw(const Board& board, const geometry::Pose& X_BC, const Drawing& drawing) {
  DrawnImage image{board.camera.width_px, board.camera.height_px, {}};
  image.grey.resize(static_cast<std::size_t>(image.width_px * image.height_px));
  std::mt19937 random(drawing.seed);
  const std::size_t cones = drawing.right_cone ? 2 : 1;
  const Hidden behind(board, cones, X_BC.translation());
  std::vector<Hidden> dark;
  for (const auto& lamp : drawing.lamps_B) dark.emplace_back(board, cones, lamp);
  const double board_light = light_of(drawing.board_level);
  const double light_of_part =
      (board_light - light_of(drawing.board_level - drawing.shadow_level)) / drawing.lamp_parts;
  const auto seen_along = [&](const Eigen::Vector2d& ideal) {
    const Eigen::Vector3d ray = X_BC.linear() * Eigen::Vector3d(ideal.x(), ideal.y(), 1.0);
    if (ray.z() >= -1e-6) return drawing.room_level;
    const Eigen::Vector3d meets = X_BC.translation() - ray * (X_BC.translation().z() / ray.z());
    const Eigen::Vector2d p_B = meets.head<2>();
    if (behind.has(p_B)) return drawing.cone_level;
    if (std::abs(p_B.x()) >= board.depth_m / 2 || std::abs(p_B.y()) >= board.width_m / 2) return drawing.room_level;
    double light = board_light;
    for (const Hidden& shadow : dark) light -= shadow.has(p_B) ? light_of_part : 0.0;
    return level_of(light) - drawing.darker(p_B);
  };
  auto next = rays_of(board.camera).begin();
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      double light = 0.0;  // of the whole pixel: it is coded after it was gathered
      const int rays = y < kFirstRowOfInterest ? 0 : kRays;
      if (rays == 0) light = light_of(drawing.room_level);
      for (int sub = 0; sub < rays; ++sub) light += light_of(seen_along(*next++)) / kRays;
      double noise = -6.0;
      for (int i = 0; i < 12; ++i) noise += random() / 4294967296.0;
      const double level = std::clamp(level_of(light) + drawing.noise * noise, 0.0, 255.0);
      image.grey[static_cast<std::size_t>(y * image.width_px + x)] = static_cast<std::uint8_t>(std::lround(level));
    }
  }
  return image;
}

}  // namespace cgsr::illumination
