// The simulated home in one piece: what one device does, the others see.
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "hal/rmp/rmp_drive.h"
#include "tests/home/rig.h"

namespace cgsr::sim {
namespace {

using test::at;
using test::make_home;
using test::ScenarioFile;

const char* const kLit = "object = \"cart\"\n[[line]]\nname = \"living lamp\"\n";

struct Pixels {
  std::vector<std::uint8_t> bytes;
  MonoTime stamp;
};

/// Moves the home to when the next image is there, and takes it.
Pixels next_image(SimulatedHome& home, hal::Camera& camera, int number) {
  const MonoTime due = MonoTime{seconds(1.0 / 30.0) * number} + home.image_delay();
  home.advance_to(due);
  const auto image = camera.next_image(due);
  EXPECT_TRUE(image) << camera.last_problem();
  if (!image) return {};
  const ImageView& view = image->view();
  return {{view.data, view.data + view.stride_bytes * view.height_px}, image->stamp()};
}

double mean_luma(const Pixels& pixels) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels.bytes.size(); i += 2) sum += pixels.bytes[i];
  return sum / (static_cast<double>(pixels.bytes.size()) / 2.0);
}

TEST(SimulatedHome, SwitchingALampChangesTheLightOfTheNextImage) {
  const ScenarioFile file(kLit);
  const auto home = make_home(file);
  const auto camera = home->take_camera();
  const auto switches = home->take_switches();
  ASSERT_TRUE(camera->start());
  ASSERT_TRUE(switches->start());
  const double dark = mean_luma(next_image(*home, *camera, 0));
  ASSERT_TRUE(switches->set("living lamp", true));
  const double lit = mean_luma(next_image(*home, *camera, 1));
  ASSERT_TRUE(switches->set("living lamp", false));
  EXPECT_GT(lit, dark + 20.0);
  EXPECT_NEAR(mean_luma(next_image(*home, *camera, 2)), dark, 1.0);
}

TEST(SimulatedHome, TheWallsSwitchTurnsOverWhatTheLineSays) {
  const ScenarioFile file(std::string(kLit) + "[[wall_switch]]\nlamp_line = \"living lamp\"\nat_s = 0.03\n");
  const auto home = make_home(file);
  const auto camera = home->take_camera();
  const auto switches = home->take_switches();
  ASSERT_TRUE(camera->start());
  ASSERT_TRUE(switches->start());
  const double dark = mean_luma(next_image(*home, *camera, 0));
  EXPECT_GT(mean_luma(next_image(*home, *camera, 1)), dark + 20.0) << "somebody's hand";
  ASSERT_TRUE(switches->set("living lamp", true));
  EXPECT_NEAR(mean_luma(next_image(*home, *camera, 2)), dark, 1.0) << "both are on: a staircase's lamp is off";
}

// The camera is fixed to the body: when it leans by p, the view tilts by p and the lens swings about the axle.
TEST(SimulatedHome, PitchMovesTheCamera) {
  const ScenarioFile file("");
  const auto home = make_home(file);
  hal::rmp::RmpDrive drive(home->take_can_bus(), {});
  ASSERT_TRUE(drive.start());
  double steepest = 0.0;
  for (int cycle = 0; cycle < 200; ++cycle) {
    const MonoTime now = at(0.01 * cycle);
    home->advance_to(now);
    static_cast<void>(drive.rearm(now));
    static_cast<void>(drive.command({cycle < 60 ? 0.0 : 0.5, 0.0}, now));
    const BaseState base = home->segway().base().state_at(now);
    const Moment moment = home->moment_at(now);
    const Eigen::Vector3d forward = moment.X_WC.linear().col(2);
    EXPECT_NEAR(-forward.z(), std::sin(base.pitch_rad), 1e-6);
    const double arm_m = 1.20 - home->segway().base().axle_height_m();
    EXPECT_NEAR(moment.X_WC.translation().x() - base.x_m, arm_m * std::sin(base.pitch_rad), 1e-6);
    steepest = std::max(steepest, std::abs(base.pitch_rad));
  }
  EXPECT_GT(steepest, 0.02) << "it never leaned: the test says nothing";
  EXPECT_GT(home->segway().base().state_at(at(1.99)).x_m, 1.5) << "it never drove";
}

TEST(SimulatedHome, TruthSpeaksOfTheImageThatWasTaken) {
  const ScenarioFile file(kLit);
  const auto home = make_home(file);
  const auto camera = home->take_camera();
  ASSERT_TRUE(camera->start());
  const Pixels image = next_image(*home, *camera, 0);
  const auto truth = home->truth(image.stamp);
  ASSERT_TRUE(truth);
  EXPECT_TRUE(truth->in_view);
  EXPECT_NEAR(truth->distance_m, std::hypot(2.4, 0.2), 0.02);
  EXPECT_NEAR(truth->box.x + truth->box.width / 2.0, 31.5 - 60.18 * 0.2 / 2.4, 1.5) << "px of 64";
  EXPECT_FALSE(home->truth(at(5.0)));
}

// The law that everything else rests on: same scenario, seed and commands, same bytes, on any number of threads.
TEST(SimulatedHomeReplay, ImagesAndBusFramesAreTheSameOnOneThreadAndOnTwo) {
  const ScenarioFile file(kLit);
  std::vector<std::vector<Pixels>> images;
  std::vector<std::vector<hal::CanFrame>> frames;
  for (const int threads : {1, 2}) {
    const auto home = make_home(file, threads);
    auto& seen = frames.emplace_back();
    home->segway().bus().tap([&seen](const hal::CanFrame& frame) { seen.push_back(frame); });
    const auto camera = home->take_camera();
    hal::rmp::RmpDrive drive(home->take_can_bus(), {});
    ASSERT_TRUE(camera->start());
    ASSERT_TRUE(drive.start());
    auto& taken = images.emplace_back();
    for (int number = 0; number < 30; ++number) {
      for (int cycle = 0; cycle < 3; ++cycle) {
        const MonoTime now = at(number / 30.0 + 0.01 * cycle);
        home->advance_to(now);
        static_cast<void>(drive.rearm(now));
        static_cast<void>(drive.command({0.3, 0.2}, now));
      }
      taken.push_back(next_image(*home, *camera, number));
    }
  }
  EXPECT_EQ(frames[0], frames[1]);
  EXPECT_GT(frames[0].size(), 500u);
  for (std::size_t i = 0; i < images[0].size(); ++i) EXPECT_EQ(images[0][i].bytes, images[1][i].bytes) << "image " << i;
  EXPECT_NE(images[0].front().bytes, images[0].back().bytes);
}

}  // namespace
}  // namespace cgsr::sim
