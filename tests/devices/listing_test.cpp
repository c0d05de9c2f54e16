// What `cgsr devices` says of a computer, on scripted kernels.
#include "src/devices/listing.h"

#include <linux/videodev2.h>

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/drivers/scripted_can.h"
#include "tests/drivers/scripted_video.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::devices {
namespace {

using test::ScriptedVideo;
using test::ScriptedVideoDevice;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const hal::v4l2::CameraNode kNode{"/dev/video4", "Maker_Camera_0042", "pci-0-usb-1", "Camera"};

TEST(CameraListing, NamesFormatsSizesAndSettingsAndTheLinesThatSelectIt) {
  ScriptedVideo kernel;
  kernel.controls[V4L2_CID_GAIN] = {0, 255, 17, true};
  kernel.controls[V4L2_CID_BRIGHTNESS] = {-10, 10, 3, true};
  ScriptedVideoDevice device(kernel);
  const std::string text = camera_text(kNode, device);
  EXPECT_THAT(text, AllOf(HasSubstr("/dev/video4  Scripted Camera (scripted)"), HasSubstr("id Maker_Camera_0042"),
                          HasSubstr("YUYV"), HasSubstr("64x48 at 100 Hz"), HasSubstr("= 17 (0 to 255 in steps of 1)"),
                          HasSubstr("= 3 (-10 to 10 in steps of 1)")));
  EXPECT_THAT(text, HasSubstr("camera.kind = \"v4l2\"\n  camera.v4l2.device = \"Maker_Camera_0042\"\n"
                              "  camera.v4l2.width_px = 64\n  camera.v4l2.height_px = 48\n"));
}

TEST(CameraListing, StepwiseSizesThatHoldTheDefaultNeedNoLineForIt) {
  ScriptedVideo kernel;
  kernel.width_px = 1920;
  kernel.height_px = 1080;
  kernel.stepwise = true;
  ScriptedVideoDevice device(kernel);
  EXPECT_THAT(camera_text({"/dev/video0", "", "", ""}, device),
              AllOf(HasSubstr("16x16 to 1920x1080 in steps of 2x2"), HasSubstr("device = \"/dev/video0\""),
                    Not(HasSubstr("width_px"))));
}

TEST(CameraListing, ACameraWithoutYuyvIsSelectedWithItsFormat) {
  ScriptedVideo kernel;
  kernel.formats = {V4L2_PIX_FMT_MJPEG};
  ScriptedVideoDevice device(kernel);
  EXPECT_THAT(camera_text(kNode, device), HasSubstr("camera.v4l2.format = \"mjpeg\""));
  kernel.formats = {V4L2_PIX_FMT_H264};
  EXPECT_THAT(camera_text(kNode, device), HasSubstr("cannot read its images"));
}

TEST(CameraListing, ANodeOfMetadataIsLeftOutAndOneThatDoesNotOpenIsNamed) {
  ScriptedVideo kernel;
  kernel.capabilities = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  ScriptedVideoDevice device(kernel);
  EXPECT_EQ(camera_text(kNode, device), "");
  kernel.plugged = false;
  EXPECT_THAT(camera_text(kNode, device), HasSubstr("/dev/video4  Camera: No such file"));
}

TEST(CanListing, FindsCanInterfacesAmongAllAndSaysTheirState) {
  const cgsr::test::ScratchFolder folder;
  const auto interface = [&folder](const std::string& name, const std::string& type, const std::string& flags) {
    const std::filesystem::path path = folder / name;
    std::filesystem::create_directories(path);
    std::ofstream(path / "type") << type << "\n";
    std::ofstream(path / "flags") << flags << "\n";
  };
  interface("lo", "772", "0x9");
  interface("can1", "280", "0x80");
  interface("can0", "280", "0x10c1");
  interface("broken", "what", "");
  test::ScriptedCan kernel;
  kernel.link = {true, CAN_STATE_ERROR_PASSIVE, 500'000};
  test::ScriptedCanSocket socket(kernel);
  const auto found = hal::socketcan::can_interfaces(socket, std::filesystem::path(folder / "lo").parent_path());
  ASSERT_EQ(found.size(), 2U);
  EXPECT_THAT(can_text(found[0]),
              AllOf(HasSubstr("can0  up, passive, 500000 bit/s"), HasSubstr("base.socketcan.interface = \"can0\"")));
  EXPECT_THAT(can_text(found[1]), HasSubstr("can1  down"));
}

TEST(LineListing, NamesEachThatHasANameOrAUserAndCountsTheRest) {
  const std::string text = lines_text({{"gpiochip0", 0, "", "", false},
                                       {"gpiochip0", 1, "", "", false},
                                       {"gpiochip0", 2, "arming", "", false},
                                       {"gpiochip0", 3, "", "led0", true},
                                       {"gpiochip1", 0, "", "", true}});
  EXPECT_EQ(text,
            "gpiochip0\n"
            "  gpiochip0:0 to 1  without names\n"
            "  gpiochip0:2  arming  input  switches.arming_line = \"arming\"\n"
            "  gpiochip0:3  (no name)  output, used by led0  switches.arming_line = \"gpiochip0:3\"\n"
            "gpiochip1\n"
            "  gpiochip1:0  (no name)  output  switches.arming_line = \"gpiochip1:0\"\n");
}

}  // namespace
}  // namespace cgsr::devices
