// The implementations that are held to the contracts: one line each.

#include <opencv2/core.hpp>

#include "hal/dummy/dummy_switches.h"
#include "hal/dummy/kinematic_drive.h"
#include "hal/replay/replay_camera.h"
#include "tests/hal/camera_contract.h"
#include "tests/hal/drive_contract.h"
#include "tests/hal/recordings.h"
#include "tests/hal/switches_contract.h"

namespace cgsr::hal {
namespace {

CameraRig make_replay(const std::string& name, ReplayPace pace) {
  auto files = std::make_shared<TempFolder>();
  ReplayParameters parameters;
  parameters.path = files->file(name);
  parameters.pace = pace;
  parameters.loop = true;
  parameters.rate_hz = 100.0;
  if (name.find(".avi") != std::string::npos) {
    write_video(parameters.path, 10, {64, 48});
  } else {
    write_folder(parameters.path, 10, {64, 48});
  }
  CameraRig rig;
  rig.world = files;
  if (pace == ReplayPace::kOwnRate) rig.clock = std::make_shared<RealClock>();
  rig.camera = std::make_unique<ReplayCamera>(parameters, rig.clock.get());
  return rig;
}

CameraRig fast_folder() {
  return make_replay("images", ReplayPace::kAsFastAsPossible);
}
CameraRig paced_folder() {
  return make_replay("images", ReplayPace::kOwnRate);
}
CameraRig fast_video() {
  return make_replay("video.avi", ReplayPace::kAsFastAsPossible);
}
CameraRig paced_video() {
  return make_replay("video.avi", ReplayPace::kOwnRate);
}

DriveRig kinematic_drive() {
  DriveRig rig;
  rig.drive = std::make_unique<KinematicDrive>();
  return rig;
}

SwitchesRig dummy_switches() {
  auto lines = std::make_unique<DummySwitches>(
      std::vector<DummyLine>{{"lamp_left"}, {"lamp_right"}, {"arm", LineDirection::kInput}});
  SwitchesRig rig;
  rig.level = [dummy = lines.get()](std::string_view name) { return dummy->level(name); };
  rig.press = [dummy = lines.get()](std::string_view name, bool on) { ASSERT_TRUE(dummy->press(name, on)); };
  rig.switches = std::move(lines);
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Replay, CameraContract,
                         testing::Values(CameraCase{"fast_folder", fast_folder},
                                         CameraCase{"paced_folder", paced_folder}, CameraCase{"fast_video", fast_video},
                                         CameraCase{"paced_video", paced_video}),
                         CaseName());

INSTANTIATE_TEST_SUITE_P(Dummy, DriveContract, testing::Values(DriveCase{"kinematic", kinematic_drive}), CaseName());

INSTANTIATE_TEST_SUITE_P(Dummy, SwitchesContract, testing::Values(SwitchesCase{"memory", dummy_switches}), CaseName());

}  // namespace
}  // namespace cgsr::hal
