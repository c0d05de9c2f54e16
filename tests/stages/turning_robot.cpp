#include "tests/stages/turning_robot.h"

#include <cmath>

#include "pipeline/stages/tasks.h"
#include "tests/support/allocation_guard.h"

namespace cgsr::stages {
namespace {

using localization::testing::leaning;
using localization::testing::Picture;

constexpr std::size_t kPixels = 320 * 240;

/// Drives straight on as soon as it is asked.
class GoesAhead final : public Task {
 public:
  Decision decide(const FrameResult&, const ImageView&, Duration) override {
    Decision decision;
    decision.goal.forward_mps = 0.3;
    decision.state = "ahead";
    return decision;
  }
};

}  // namespace

TurningRobot::TurningRobot() : decide_(std::make_unique<GoesAhead>()) {}

LocalizationSetup TurningRobot::setup() {
  LocalizationSetup setup;
  setup.map = map_;
  setup.camera = camera_;
  setup.X_RC = X_RC_;
  setup.seeks_first_pose = true;
  setup.seek_turn_radps = kTurn_radps;
  for (double x_m = 0.5; x_m < 3.0; x_m += 0.4) {
    for (double y_m = 0.5; y_m < 3.6; y_m += 0.4) setup.places_m.emplace_back(x_m, y_m);
  }
  localization::PriorSigmas sigmas = localization::PriorSigmas::floor();
  sigmas.x_m = sigmas.y_m = 0.02;
  sigmas.heading_rad = 0.01;
  setup.start = localization::prior_at(X_WR * X_RC_, sigmas);
  return setup;
}

const Decision& TurningRobot::step(bool dark) {
  ++images;
  const double pitch_rad = lean_rad * (images % 3 - 1);
  std::vector<std::uint8_t> yuyv(2 * kPixels, 2);
  if (!dark) {
    const Picture picture(*map_, X_WR * leaning(pitch_rad, LocalizationSetup{}.axle_height_m) * X_RC_, camera_, 1.5,
                          static_cast<std::uint32_t>(images));
    for (std::size_t i = 0; i < kPixels; ++i) yuyv[2 * i] = picture.pixels[i];
  }
  for (std::size_t i = 0; i < kPixels; ++i) yuyv[2 * i + 1] = 128;
  const ImageView image{.data = yuyv.data(),
                        .width_px = camera_.width_px,
                        .height_px = camera_.height_px,
                        .stride_bytes = 2 * camera_.width_px,
                        .format = PixelFormat::kYuyv};
  frame.view = {decode_.update(image), {}, Duration::zero()};
  auto budget = runtime::StageBudget::of_units(units);
  hal::Odometry odometry;  // it began elsewhere
  odometry.stamp = MonoTime{seconds(kImage_s * images)};
  odometry.x_m = 5.0;
  odometry.heading_rad = turned_rad + 1.0;
  odometry.pitch_rad = pitch_rad;
  const test::AllocationGuard guard;
  frame.pose = {localize_->update(budget, image, frame.view, odometry), {}, Duration::zero()};
  allocations += guard.allocations();
  for (const Event& event : frame.pose.value.events) {
    if (event.source != "pose") phases.push_back(std::string(event.source) + ": " + std::string(event.state));
  }
  frame.decision = {decide_.update(ImageLease(), frame), {}, Duration::zero()};
  const Decision& decision = frame.decision.value;
  turned_rad += kImage_s * decision.goal.left_radps;
  X_WR = X_WR * geometry::pose_on_floor(0.0, 0.0, kImage_s * decision.goal.left_radps);
  return decision;
}

double TurningRobot::off_m() const {
  return std::hypot(pose().robot.x_m - X_WR.translation().x(), pose().robot.y_m - X_WR.translation().y());
}

}  // namespace cgsr::stages
