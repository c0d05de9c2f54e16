#include "docs/guides/write-a-driver/ramp_camera.h"

#include "tests/hal/camera_contract.h"

namespace cgsr::hal {
namespace {

CameraRig make_ramp() {
  CameraRig rig;
  rig.clock = std::make_shared<RealClock>();
  rig.camera = std::make_unique<RampCamera>(*rig.clock, RampCameraParameters{64, 48, 100.0});
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Ramp, CameraContract, testing::Values(CameraCase{"ramp", make_ramp}), CaseName());

TEST(RampCamera, TheRampMovesByOnePixelPerImage) {
  CameraRig rig = make_ramp();
  ASSERT_TRUE(rig.camera->start());
  const auto first = rig.camera->next_image(MonoTime::max());
  const auto second = rig.camera->next_image(MonoTime::max());
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->view().row(0)[2], second->view().row(0)[0]);
}

}  // namespace
}  // namespace cgsr::hal
