#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/runtime/stage_budget.h"
#include "pipeline/stages/decide_stage.h"
#include "pipeline/stages/decode_stage.h"
#include "pipeline/stages/localize_stage.h"
#include "tests/localization/small_room.h"

namespace cgsr::stages {

/// A robot in the small room, with its stages from the image to the decision. It turns as is decided, drives nowhere, and its task would drive straight on.
class TurningRobot {
 public:
  static constexpr double kImage_s = 0.25;
  static constexpr double kTurn_radps = 0.7;

  TurningRobot();

  /// \return what its LocalizeStage is made of: it seeks its first pose.
  LocalizationSetup setup();
  void make(LocalizationSetup setup) { localize_ = std::make_unique<LocalizeStage>(std::move(setup)); }

  /// One image from where the robot is, black in the dark; then the robot does what was decided.
  const Decision& step(bool dark = false);

  geometry::Pose X_WR = geometry::pose_on_floor(2.2, 2.1, -2.0);
  double turned_rad = 0.0;
  double lean_rad = 0.0;  ///< to and fro from image to image.
  std::uint32_t units = runtime::StageBudget::kAll;

  int images = 0;
  FrameResult frame;
  std::vector<std::string> phases;  ///< of the search of the whole map: what is sought, and the phase.
  std::uint64_t allocations = 0;    ///< of LocalizeStage::update.

  [[nodiscard]] const PoseEstimate& pose() const { return frame.pose.value; }
  [[nodiscard]] LocalizeStage& localize() { return *localize_; }
  [[nodiscard]] DecideStage& decide() { return decide_; }
  /// How far the robot is from where it says that it is.
  [[nodiscard]] double off_m() const;

 private:
  std::shared_ptr<const world::Map> map_ = std::make_shared<world::Map>(localization::testing::small_room());
  geometry::Camera camera_ = geometry::Camera{}.scaled_to(320, 240);
  geometry::Pose X_RC_ = localization::testing::in_small_room(0.0, 0.0, 0.0);
  DecodeStage decode_{DecodeStage::Setup{320, 240, {}}};
  DecideStage decide_;
  std::unique_ptr<LocalizeStage> localize_;
};

}  // namespace cgsr::stages
