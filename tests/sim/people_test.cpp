#include "hal/sim/people/person.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/objdetect.hpp>

#include "hal/sim/people/identity.h"
#include "hal/sim/render/sensor.h"
#include "hal/sim/render/truth_images.h"
#include "hal/sim/scene/portable_math.h"
#include "tests/sim/small_scenes.h"

namespace cgsr::sim {
namespace {

// One person in a plain room under a ceiling lamp.
struct Portrait {
  Scene scene = dark_scene();
  int head = -1;
  std::unique_ptr<Renderer> renderer;

  explicit Portrait(int identity) {
    const int wall = matt(scene, Rgb(0.42F, 0.44F, 0.46F));
    scene.add_static("wall", make_box({0.1, 8, 3.2}), wall, pose_at({4.5, 0, 1.6}));
    scene.add_static("floor", make_rectangle(10, 8), wall);
    add_person(scene, {"sitter", identity, 1.74, {}});
    add_lamp(scene, {-1.6, 0.4, 2.75}, 2600, 0.0, Rgb(1.0F, 0.93F, 0.84F));
    scene.ambient.illuminance_lux = Rgb(60, 58, 55);
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
      if (scene.parts[i].name == "sitter/head") head = static_cast<int>(i);
    }
    renderer = renderer_for(scene, CameraModel().scaled_to(320, 240), 4);
  }

  void turn(double yaw_rad) { scene.figures[0].path = Path::standing({0, 0, 0}, kPi + yaw_rad); }
};

class Detector {
 public:
  Detector() : faces_("/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml") {}
  [[nodiscard]] bool ready() const { return !faces_.empty(); }

  // Is there a face where the head is?
  bool finds(Portrait& portrait, double distance_m, std::uint32_t seed) {
    Renderer& renderer = *portrait.renderer;
    const SceneState state = state_at(portrait.scene, 0.0);
    const Pose X_WC = look_at({-distance_m, 0.05, 1.5}, {0, 0, 1.55});
    RadianceImage image;
    renderer.draw(state, X_WC, image);
    cv::Mat yuyv(240, 320, CV_8UC2);
    SensorSettings settings;
    settings.gain = 1.5;
    sensor_.measure(image, settings, seed, 0, {yuyv.data, 320, 240, 640}, renderer.workers());
    cv::Mat grey;
    cv::extractChannel(yuyv, grey, 0);
    std::vector<cv::Rect> found;
    faces_.detectMultiScale(grey, found, 1.1, 3, 0, {20, 20});
    if (const char* folder = std::getenv("CGSR_SHOW")) {
      cv::Mat bgr;
      cv::cvtColor(yuyv, bgr, cv::COLOR_YUV2BGR_YUYV);
      for (const cv::Rect& box : found) cv::rectangle(bgr, box, {0, 255, 0});
      cv::imwrite(std::string(folder) + "/face" + std::to_string(seed) + ".png", bgr);
    }
    const FigureView head = figure_view(renderer, state, X_WC, 0, {portrait.head});
    for (const cv::Rect& box : found) {
      const double x = box.x + box.width / 2.0 - (head.whole.x + head.whole.width / 2);
      const double y = box.y + box.height / 2.0 - (head.whole.y + head.whole.height / 2);
      if (std::abs(x) < 0.35 * head.whole.width && std::abs(y) < 0.35 * head.whole.height) return true;
    }
    return false;
  }

 private:
  cv::CascadeClassifier faces_;
  Sensor sensor_;
};

TEST(PeopleFaces, AreFoundFromTheFrontAndNotFromTheSide) {
  Detector detector;
  ASSERT_TRUE(detector.ready()) << "Debian's opencv-data has the cascade";
  std::map<double, int> found;
  std::uint32_t images = 0;
  for (int identity = 0; identity < kIdentities; ++identity) {
    Portrait portrait(identity);
    std::string row;
    for (const double yaw : {0.0, 10.0, 20.0, 65.0, 75.0, 90.0}) {
      int hits = 0;
      for (const double distance : {1.0, 1.5, 2.0, 2.5}) {
        portrait.turn(degrees(images % 2 == 0 ? yaw : -yaw));
        hits += detector.finds(portrait, distance, ++images) ? 1 : 0;
      }
      found[yaw] += hits;
      row += " " + std::to_string(hits);
    }
    std::printf("identity %d: found at 0 10 20 65 75 90 degrees in%s of 4 distances\n", identity, row.c_str());
  }
  const double front = (found[0.0] + found[10.0] + found[20.0]) / 96.0;
  const double side = (found[65.0] + found[75.0] + found[90.0]) / 96.0;
  std::printf("found: %.1f %% within 20 degrees, %.1f %% beyond 65\n", 100 * front, 100 * side);
  EXPECT_GE(front, 0.95);
  EXPECT_LE(side, 0.03);
}

// A number draws the same face every time, another number another one.
TEST(PeopleFaces, DrawnByTheirNumberAreFoundFromTheFrontToo) {
  Detector detector;
  ASSERT_TRUE(detector.ready()) << "Debian's opencv-data has the cascade";
  int found = 0, looked = 0;
  std::uint32_t images = 100;
  for (int number = kIdentities; number < kIdentities + 12; ++number) {
    const Identity who = identity(number), again = identity(number), other = identity(number + 1);
    EXPECT_EQ(who.skin, again.skin);
    EXPECT_EQ(who.mouth_down_m, again.mouth_down_m);
    EXPECT_NE(who.mouth_down_m, other.mouth_down_m);
    Portrait portrait(number);
    for (const auto& [yaw, distance] : {std::pair{0.0, 1.0}, {10.0, 1.6}, {-15.0, 2.2}}) {
      portrait.turn(degrees(yaw));
      found += detector.finds(portrait, distance, ++images) ? 1 : 0;
      ++looked;
    }
  }
  std::printf("drawn faces: %d of %d found\n", found, looked);
  EXPECT_GE(found, looked * 9 / 10);
}

// SIFT descriptors of a head as the camera sees it at 640x480.
cv::Mat descriptors(const Portrait& portrait, Renderer& renderer, double distance_m, std::uint32_t seed) {
  static const Sensor sensor;
  static const auto sift = cv::SIFT::create(0, 3, 0.02);
  const SceneState state = state_at(portrait.scene, 0.0);
  const Pose X_WC = look_at({-distance_m, 0.05, 1.5}, {0, 0, 1.55});
  RadianceImage image;
  renderer.draw(state, X_WC, image);
  cv::Mat yuyv(480, 640, CV_8UC2);
  SensorSettings settings;
  settings.gain = 1.5;
  sensor.measure(image, settings, seed, 0, {yuyv.data, 640, 480, 1280}, renderer.workers());
  cv::Mat grey;
  cv::extractChannel(yuyv, grey, 0);
  const Box box = figure_view(renderer, state, X_WC, 0, {portrait.head}).whole;
  std::vector<cv::KeyPoint> points;
  cv::Mat result;
  sift->detectAndCompute(grey(cv::Rect(cv::Rect2d(box.x, box.y, box.width, box.height))), {}, points, result);
  return result;
}

// A descriptor counts for the identity it is nearest to when every other identity is clearly farther.
int recognised(const cv::Mat& seen, const std::vector<cv::Mat>& enrolled) {
  std::vector<int> votes(enrolled.size(), 0);
  for (int i = 0; i < seen.rows; ++i) {
    std::vector<std::pair<double, int>> nearest;
    for (std::size_t who = 0; who < enrolled.size(); ++who) {
      double least = 1e9;
      for (int j = 0; j < enrolled[who].rows; ++j) least = std::min(least, cv::norm(seen.row(i), enrolled[who].row(j)));
      nearest.emplace_back(least, static_cast<int>(who));
    }
    std::sort(nearest.begin(), nearest.end());
    if (nearest[0].first < 0.9 * nearest[1].first) ++votes[static_cast<std::size_t>(nearest[0].second)];
  }
  return static_cast<int>(std::max_element(votes.begin(), votes.end()) - votes.begin());
}

TEST(PeopleFaces, DifferEnoughForSift) {
  std::vector<Portrait> people;
  std::vector<std::unique_ptr<Renderer>> cameras;
  std::vector<cv::Mat> enrolled;
  people.reserve(kIdentities);  // renderers look into the scenes
  std::uint32_t seed = 0;
  for (int i = 0; i < kIdentities; ++i) {
    people.emplace_back(i);
    cameras.push_back(renderer_for(people.back().scene, CameraModel(), 4));
    people.back().turn(degrees(-8));
    cv::Mat both = descriptors(people.back(), *cameras.back(), 1.0, ++seed);
    people.back().turn(degrees(8));
    cv::vconcat(both, descriptors(people.back(), *cameras.back(), 1.2, ++seed), both);
    enrolled.push_back(both);
  }
  int right = 0;
  int trials = 0;
  for (int i = 0; i < kIdentities; ++i) {
    for (const auto& [distance, yaw] : {std::pair{0.9, 0.0}, {1.3, 12.0}, {1.6, -5.0}}) {
      people[static_cast<std::size_t>(i)].turn(degrees(yaw));
      const cv::Mat seen =
          descriptors(people[static_cast<std::size_t>(i)], *cameras[static_cast<std::size_t>(i)], distance, ++seed);
      right += recognised(seen, enrolled) == i ? 1 : 0;
      ++trials;
    }
  }
  std::printf("SIFT tells %d of %d apart\n", right, trials);
  EXPECT_GE(right, trials - 1);
}

}  // namespace
}  // namespace cgsr::sim
