#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "pipeline/localization/localizer.h"
#include "tests/localization/random_numbers.h"
#include "tests/localization/small_room.h"
#include "tests/support/counted_budget.h"

namespace cgsr::localization::testing {

inline constexpr double kDegree = std::numbers::pi / 180.0;

inline geometry::Camera room_camera() {
  geometry::Camera camera = geometry::Camera{}.scaled_to(320, 240);
  camera.k1 = -0.075;
  camera.k2 = 0.045;
  return camera;
}

struct Error {
  double position_m;
  double direction_deg;
};
inline Error error_of(const geometry::Pose& truth, const geometry::Pose& answer) {
  const geometry::Vector6d step = geometry::step_between(truth, answer);
  return {step.head<3>().norm(), step.tail<3>().norm() / kDegree};
}

inline Prior drawn_prior(const geometry::Pose& truth, const PriorSigmas& sigmas, RandomNumbers& random) {
  Prior prior = prior_at(truth, sigmas);
  geometry::Vector6d off;
  for (int i = 0; i < 6; ++i) off[i] = std::sqrt(prior.covariance(i, i)) * std::clamp(random.normal(), -2.5, 2.5);
  prior.X_WC = geometry::moved(truth, off);
  return prior;
}

// The same image until there is an answer, as a robot that stands.
inline Correction answer_of(Localizer& localizer, const ImageView& image, const Prior& prior, int& images) {
  UnlimitedBudget budget;
  Correction answer;
  for (images = 1; images < 200; ++images) {
    answer = localizer.correct(image, prior, budget);
    if (answer.reason != Reason::kSearching) break;
  }
  return answer;
}

inline constexpr PriorSigmas kTracking{.x_m = 0.02, .y_m = 0.02, .z_m = 0.005, .heading_rad = 0.01, .tilt_rad = 0.005};

/// What no map holds: strips of tape on a wall, all upright.
inline world::Map wall_of_upright_strips() {
  MapBuilder b;
  const std::uint32_t wall = b.rectangle({2.5F, 8, -4}, {0, -16, 0}, {0, 0, 8}, b.grey(0.2F));
  for (const float left_m : {-0.6F, -0.2F, 0.2F, 0.6F})
    b.rectangle({2.498F, left_m, -3}, {0, -0.04F, 0}, {0, 0, 6}, b.grey(0.8F), wall);
  return b.map;
}

/// Strips of tape on a wall, all level: what is upright of them is too short to be seen.
inline world::Map wall_of_strips() {
  MapBuilder b;
  const std::uint32_t wall = b.rectangle({2.5F, 8, -4}, {0, -16, 0}, {0, 0, 8}, b.grey(0.2F));
  for (const float height_m : {0.1F, 0.35F, 0.6F, 0.85F}) {
    const float left_m = height_m < 0.5F ? 0.5F : 0.7F;
    b.rectangle({2.498F, left_m, height_m}, {0, -1.1F, 0}, {0, 0, 0.04F}, b.grey(0.8F), wall);
  }
  return b.map;
}

}  // namespace cgsr::localization::testing
