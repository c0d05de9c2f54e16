#include "src/output/picture.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/output/picture_size.h"
#include "tests/world/scratch.h"

namespace cgsr::app {
namespace {

using testing::HasSubstr;

class Picture : public testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return (scratch_ / name).string(); }

  /// The message that a file of this text is refused with; empty when it is not.
  [[nodiscard]] std::string refusal(const std::string& name, const std::string& text) const {
    std::ofstream(at(name), std::ios::binary) << text;
    const auto picture = read_picture(at(name), camera_, "camera.yaml");
    return picture ? "" : picture.error().message;
  }

  geometry::Camera camera_ = [] {
    geometry::Camera camera;
    camera.width_px = 32;
    camera.height_px = 24;
    return camera;
  }();

 private:
  world::ScratchFolder scratch_;
};

TEST_F(Picture, WhatIsWrittenIsReadBack) {
  const cv::Mat picture(24, 32, CV_8UC3, cv::Scalar(10, 20, 30));
  ASSERT_TRUE(write_picture(at("a.png"), picture));
  const auto back = read_picture(at("a.png"), camera_, "camera.yaml");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(cv::norm(*back, picture, cv::NORM_INF), 0.0);
}

TEST_F(Picture, ItsHeaderStatesItsSize) {
  const cv::Mat picture(24, 32, CV_8UC3, cv::Scalar(10, 20, 30));
  for (const char* name : {"a.png", "a.jpg", "a.bmp", "a.ppm"}) {
    ASSERT_TRUE(write_picture(at(name), picture)) << name;
    EXPECT_EQ(size_in_header(at(name)), cv::Size(32, 24)) << name;
    EXPECT_TRUE(read_picture(at(name), camera_, "camera.yaml")) << name;
  }
}

using PictureFault = Picture;

TEST_F(PictureFault, ReadingNamesTheFileAndTheCause) {
  EXPECT_THAT(refusal("words.png", "no image"), HasSubstr("words.png: no image that can be read"));
  EXPECT_THAT(refusal("small.ppm", "P6\n1 1\n255\nabc"),
              HasSubstr("small.ppm: 1x1 px, but camera.yaml is of a camera of 32x24"));
  // The header says enough: what would take 3 GB is not decoded.
  EXPECT_THAT(refusal("wide.ppm", "P6\n# from afar\n2000000 2\n255\n"), HasSubstr("wide.ppm: 2000000x2 px, but"));
  EXPECT_THAT(refusal("large.png", "\x89PNG\r\n\x1A\n" + std::string("\0\0\0\rIHDR\0\0\x75\x30\0\0\x75\x30", 16)),
              HasSubstr("large.png: 30000x30000 px, but"));
  EXPECT_THAT(refusal("cut.png", "\x89PNG\r\n\x1A\n"), HasSubstr("cut.png: no image that can be read"));
  EXPECT_THAT(read_picture("/nowhere/a.png", camera_, "camera.yaml").error().message,
              HasSubstr("/nowhere/a.png: no image"));
}

TEST_F(PictureFault, WritingNamesTheFile) {
  const cv::Mat picture(24, 32, CV_8UC3, cv::Scalar::all(0));
  for (const std::string& name : {at("a.nothing"), at("a")}) {
    const auto written = write_picture(name, picture);
    ASSERT_FALSE(written) << name;
    EXPECT_THAT(written.error().message, HasSubstr(name + ": cannot be written as an image: expected a name"));
  }
  EXPECT_THAT(write_picture("/nowhere/a.png", picture).error().message,
              HasSubstr("/nowhere/a.png: cannot be written: No such file"));
}

}  // namespace
}  // namespace cgsr::app
