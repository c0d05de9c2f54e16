// The search for fixed settings, on a scripted camera in a room of a given brightness.
#include "src/devices/camera_setup.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/output/terminal_picture.h"
#include "tests/drivers/scripted_video.h"

namespace cgsr::devices {
namespace {

using test::ScriptedVideo;
using test::ScriptedVideoDevice;
using testing::HasSubstr;
using testing::IsEmpty;

/// A camera that sees one grey: encoded luma of light times exposure.
struct Room {
  explicit Room(double light_per_ms) {
    kernel.period = std::chrono::milliseconds(2);
    kernel.controls[V4L2_CID_EXPOSURE_AUTO] = {0, 3, 3, true};
    kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE] = {1, 5000, 100, true};
    kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE] = {0, 1, 0, true};
    kernel.controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE] = {2800, 6500, 3900, true};
    kernel.byte_of = [this, light_per_ms](std::uint32_t) {
      const double linear = light_per_ms * kernel.controls[V4L2_CID_EXPOSURE_ABSOLUTE].value / 10.0;
      return static_cast<std::uint8_t>(16.0 + 219.0 * std::pow(std::min(linear, 1.0), 1.0 / 2.2));
    };
    parameters.width_px = 64;
    parameters.height_px = 48;
    parameters.rate_hz = 30.0;
  }

  Result<CameraSetup> set_up() {
    const CameraAccess access{[this] { return std::make_unique<ScriptedVideoDevice>(kernel); },
                              [](const std::string& name) { return std::optional(name); }};
    return set_up_camera(parameters, access,
                         [this](const ImageView&, const std::string& label) { shown.push_back(label); });
  }

  ScriptedVideo kernel;
  hal::v4l2::V4l2Parameters parameters;
  std::vector<std::string> shown;
};

TEST(CameraSetup, FindsAnExposureUnderWhichNothingIsBlackOrCutOff) {
  for (const double light_per_ms : {0.03, 0.1, 0.5, 3.0}) {
    Room room(light_per_ms);
    const auto setup = room.set_up();
    ASSERT_TRUE(setup) << setup.error().message;
    const int bright = setup->histogram.quantile(0.98);
    EXPECT_GE(bright, 165) << light_per_ms;
    EXPECT_LE(bright, 225) << light_per_ms;
    EXPECT_EQ(setup->histogram.black_share() + setup->histogram.saturated_share(), 0.0);
    EXPECT_EQ(room.kernel.controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
    EXPECT_EQ(room.kernel.controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 0);
    EXPECT_EQ(setup->parameters.white_balance_k, 3900) << "where the automatic had arrived";
    EXPECT_THAT(setup->notes, IsEmpty());
    EXPECT_GE(room.shown.size(), 2U);
  }
}

TEST(CameraSetup, NeverExposesLongerThanAPeriodAndSaysWhatTheLightLacks) {
  Room dark(0.00001);
  const auto setup = dark.set_up();
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_LE(setup->parameters.exposure_s, 1.0 / 30.0 + 1e-9);
  EXPECT_THAT(setup->notes, testing::Contains(HasSubstr("are black: more light")));
  Room sun(500.0);
  const auto cut = sun.set_up();
  ASSERT_TRUE(cut) << cut.error().message;
  EXPECT_THAT(cut->notes, testing::Contains(HasSubstr("are cut off: less light")));
}

TEST(CameraSetup, SaysWhatTheCameraCannotFix) {
  Room room(0.1);
  room.kernel.controls.clear();
  room.kernel.byte_of = [](std::uint32_t) { return std::uint8_t{120}; };
  const auto setup = room.set_up();
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_THAT(setup->notes, testing::ElementsAre(HasSubstr("no fixed white balance"), HasSubstr("no fixed exposure")));
  EXPECT_EQ(setup_lines(*setup),
            "camera.kind = \"v4l2\"\ncamera.v4l2.device = \"/dev/video0\"\ncamera.v4l2.width_px = 64\n"
            "camera.v4l2.height_px = 48\ncamera.v4l2.white_balance_k = 0\n");
}

TEST(CameraSetup, ACameraThatGivesNoImageIsNamed) {
  Room room(0.1);
  room.kernel.plugged = false;
  const auto setup = room.set_up();
  ASSERT_FALSE(setup);
  EXPECT_THAT(setup.error().message, HasSubstr("/dev/video0"));
}

// Whatever the light, the search nears its target and does not oscillate.
TEST(NextExposure, ConvergesWithinTheTriesOfTheSetup) {
  for (double light_per_s = 1.0; light_per_s < 1e6; light_per_s *= 3.0) {
    double exposure_s = 0.01;
    for (int i = 0; i < 10; ++i) {
      LumaHistogram histogram;
      const double linear = std::min(1.0, light_per_s * exposure_s);
      histogram.counts[static_cast<std::size_t>(16.0 + 219.0 * std::pow(linear, 1.0 / 2.2))] = 100;
      histogram.pixels = 100;
      exposure_s = next_exposure_s(exposure_s, histogram);
    }
    EXPECT_GT(light_per_s * exposure_s, 0.5) << light_per_s;
    EXPECT_LT(light_per_s * exposure_s, 0.9) << light_per_s;
  }
}

TEST(TerminalPicture, ShowsDarkAndBrightAndFitsItsColumns) {
  std::vector<std::uint8_t> pixels(64 * 48 * 2, 128);
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) pixels[static_cast<std::size_t>(2 * (64 * y + x))] = x < 32 ? 16 : 235;
  }
  const ImageView view{pixels.data(), 64, 48, 128, PixelFormat::kYuyv};
  const std::string letters = app::terminal_picture(view, 16, false);
  EXPECT_EQ(letters.substr(0, 17), "        @@@@@@@@\n");
  EXPECT_EQ(std::count(letters.begin(), letters.end(), '\n'), 6);
  const std::string colors = app::terminal_picture(view, 16, true);
  EXPECT_THAT(colors, HasSubstr("\x1b[38;2;0;0;0;48;2;0;0;0m"));
  EXPECT_THAT(colors, HasSubstr("38;2;255;255;255"));
}

}  // namespace
}  // namespace cgsr::devices
