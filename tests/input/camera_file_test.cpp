#include "src/input/camera_file.h"

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cgsr::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kGood = R"(image_width: 640
image_height: 480
camera_name: head
camera_matrix:
  rows: 3
  cols: 3
  data: [601.8, 0.0, 319.5, 0.0, 579.4, 239.5, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.075, 0.045, 0.0006, -0.0004, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

/// The good file with one piece of its text put in place of another.
std::string with(const std::string& old_text, const std::string& new_text) {
  std::string text = kGood;
  const std::size_t at = text.find(old_text);
  EXPECT_NE(at, std::string::npos) << old_text;
  return text.replace(at, old_text.size(), new_text);
}

std::string refusal(const std::string& text) {
  const auto camera = parse_camera(text, "camera.yaml");
  return camera ? "" : camera.error().message;
}

TEST(CameraFile, ReadsWhatRosWrites) {
  const auto camera = parse_camera(kGood, "camera.yaml");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->width_px, 640);
  EXPECT_EQ(camera->height_px, 480);
  EXPECT_EQ(camera->fx_px, 601.8);
  EXPECT_EQ(camera->fy_px, 579.4);
  EXPECT_EQ(camera->cx_px, 319.5);
  EXPECT_EQ(camera->cy_px, 239.5);
  EXPECT_EQ(camera->k1, -0.075);
  EXPECT_EQ(camera->k2, 0.045);
  EXPECT_EQ(camera->p1, 0.0006);
  EXPECT_EQ(camera->p2, -0.0004);
  EXPECT_EQ(camera->k3, 0.0);
}

TEST(CameraFile, TakesFourCoefficientsAndNumbersWithASign) {
  const auto camera = parse_camera(
      with("cols: 5\n  data: [-0.075, 0.045, 0.0006, -0.0004, 0.0]", "cols: 4\n  data: [+0.1, 0, 0, 1e-4]"),
      "camera.yaml");
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->k1, 0.1);
  EXPECT_EQ(camera->p2, 1e-4);
}

TEST(CameraFileProperty, WhatIsWrittenReadsBackExactly) {
  geometry::Camera camera;
  camera.fx_px = 601.80000000000007;
  camera.fy_px = 600.0;
  camera.cx_px = 1.0 / 3.0 * 1000.0;
  camera.k1 = -1.0 / 7.0;
  camera.k2 = 1e-7;
  camera.p1 = -3e-5;
  camera.k3 = 0.01;
  const std::string text = camera_as_yaml(camera, "head");
  EXPECT_THAT(text, HasSubstr("1.0e-07")) << "without a point some readers take it for a word";
  const auto again = parse_camera(text, "camera.yaml");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->fx_px, camera.fx_px);
  EXPECT_EQ(again->fy_px, camera.fy_px);
  EXPECT_EQ(again->cx_px, camera.cx_px);
  EXPECT_EQ(again->k1, camera.k1);
  EXPECT_EQ(again->k2, camera.k2);
  EXPECT_EQ(again->p1, camera.p1);
  EXPECT_EQ(again->k3, camera.k3);
}

TEST(CameraFileFault, SaysWhatIsNoYaml) {
  EXPECT_THAT(refusal("image_width: [640\nimage_height: 480\n"), HasSubstr("is not YAML"));
  EXPECT_THAT(refusal(""), HasSubstr("is no camera file"));
  EXPECT_THAT(refusal("just words"), HasSubstr("is no camera file"));
  EXPECT_THAT(refusal(std::string(2000, '[')), HasSubstr("camera.yaml"));
  EXPECT_THAT(refusal(std::string("\x01\x02\x7F\xFF\x00", 5)), HasSubstr("camera.yaml"));
}

TEST(CameraFileFault, NamesWhatIsMissing) {
  EXPECT_THAT(refusal(with("image_width: 640\n", "")), HasSubstr("there is no 'image_width'"));
  EXPECT_THAT(refusal(with("image_height", "height")), HasSubstr("there is no 'image_height'"));
  EXPECT_THAT(refusal(with("camera_matrix", "matrix")), HasSubstr("there is no 'camera_matrix'"));
  EXPECT_THAT(refusal(with("distortion_model: plumb_bob\n", "")), HasSubstr("there is no 'distortion_model'"));
  EXPECT_THAT(refusal(with("distortion_coefficients", "D")), HasSubstr("there is no 'distortion_coefficients'"));
}

TEST(CameraFileFault, NamesLineValueAndWhatWasExpected) {
  EXPECT_EQ(refusal(with("640", "64.5")), "camera.yaml:1: image_width is 64.5: expected a whole number, 16..8192 px");
  EXPECT_THAT(refusal(with("640", "-640")), HasSubstr("image_width is -640"));
  EXPECT_THAT(refusal(with("480", "many")), HasSubstr("camera.yaml:2: image_height holds 'many'"));
  EXPECT_THAT(refusal(with("601.8", ".nan")), StartsWith("camera.yaml:7: camera_matrix holds '.nan'"));
  EXPECT_THAT(refusal(with("601.8", "inf")), HasSubstr("expected a finite number"));
  EXPECT_THAT(refusal(with("601.8, 0.0", "601.8, 3.0")), HasSubstr("without skew"));
  EXPECT_THAT(refusal(with("601.8", "-601.8")), HasSubstr("fx is -601.8: expected the focal length"));
  EXPECT_THAT(refusal(with("601.8", "0")), HasSubstr("fx is 0"));
  EXPECT_THAT(refusal(with("601.8", "6018")), HasSubstr("fx is 6018 and fy 579.4"));
  EXPECT_THAT(refusal(with("319.5", "3195")), HasSubstr("the optical axis meets the image at (3195, 239.5)"));
  EXPECT_THAT(refusal(with(", 1.0]", "]")), HasSubstr("camera_matrix holds 8 numbers: expected rows x cols = 3 x 3"));
  EXPECT_THAT(refusal(with("[601.8", "[[601.8]")), HasSubstr("camera_matrix"));
  EXPECT_THAT(refusal(with("plumb_bob", "equidistant")),
              StartsWith("camera.yaml:8: distortion_model is 'equidistant': expected plumb_bob"));
  EXPECT_THAT(refusal(with("cols: 5\n  data: [-0.075, 0.045, 0.0006, -0.0004, 0.0]",
                           "cols: 8\n  data: [-0.075, 0.045, 0.0006, -0.0004, 0.0, 0, 0, 0]")),
              HasSubstr("distortion_coefficients has 8 numbers"));
  EXPECT_THAT(refusal(with("-0.075", "-3")), HasSubstr("fold the image over itself"));
  EXPECT_EQ(refusal(with("-0.075", "1e300")),
            "camera.yaml:12: distortion_coefficients: k1 is 1e+300: expected -10..10");
  EXPECT_THAT(refusal(with("0.045", "-1e3")), HasSubstr("k2 is -1000: expected -100..100"));
  EXPECT_THAT(refusal(with("0.0006", "1.5")), HasSubstr("p1 is 1.5: expected -1..1"));
  EXPECT_THAT(refusal(with("-0.0004", "-2")), HasSubstr("p2 is -2: expected -1..1"));
  EXPECT_THAT(refusal(with("-0.0004, 0.0", "-0.0004, 1e4")), HasSubstr("k3 is 10000: expected -1000..1000"));
  EXPECT_THAT(refusal(with("-0.075, 0.045, 0.0006, -0.0004, 0.0", "0.15, 1.44, 0.72, 0.046, 0.0")),
              HasSubstr("cannot be taken out again at the corner (0, 0): expected a lens that shows every direction"));
  EXPECT_EQ(refusal(with("-0.075, 0.045, 0.0006, -0.0004, 0.0", "-0.38, 0.21, 0.002, -0.001, -0.07")), "");
  EXPECT_THAT(refusal(with("camera_name: head", "image_width: 320")),
              HasSubstr("camera.yaml:3: 'image_width' is there a second time"));
}

TEST(CameraFileFault, SaysWhyAFileCannotBeRead) {
  EXPECT_THAT(read_camera("/nowhere/camera.yaml").error().message, HasSubstr("/nowhere/camera.yaml: cannot be read"));
  EXPECT_THAT(read_camera("/").error().message, HasSubstr("is a folder"));
  EXPECT_THAT(read_camera("/dev/zero").error().message, HasSubstr("larger than"));
}

// Whatever single byte is changed or wherever the text ends, the answer is a camera or words.
TEST(CameraFileFault, HoldsAnyDamage) {
  const std::string good = kGood;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const char c : {'\0', '[', '{', ':', '&', '*', '9', '\n'}) {
      std::string text = good;
      text[i] = c;
      const auto camera = parse_camera(text, "camera.yaml");
      EXPECT_THAT(camera ? "camera.yaml" : camera.error().message, HasSubstr("camera.yaml"));
    }
    const auto cut = parse_camera(good.substr(0, i), "camera.yaml");
    EXPECT_THAT(cut ? "camera.yaml" : cut.error().message, HasSubstr("camera.yaml"));
  }
}

}  // namespace
}  // namespace cgsr::app
