// cgsr map as a user meets it.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

using ::testing::HasSubstr;

/// A white board on a grey floor, a camera and a pose that looks at them.
class MapCommand : public ::testing::Test {
 protected:
  MapCommand() {
    std::ofstream(scratch_ / "map.obj") << "mtllib map.mtl\n"
                                           "usemtl grey\nv 0 -3 0\nv 6 -3 0\nv 6 3 0\nv 0 3 0\nf 1 2 3 4\n"
                                           "usemtl white\nv 3 -0.5 0\nv 3 0.5 0\nv 3 0.5 1\nv 3 -0.5 1\nf 5 8 7 6\n";
    std::ofstream(scratch_ / "map.mtl") << "newmtl grey\nKd 0.4 0.4 0.4\nnewmtl white\nKd 0.9 0.9 0.9\n";
    std::ofstream(scratch_ / "camera.yaml")
        << "image_width: 320\nimage_height: 240\ncamera_name: test\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
           "  data: [300.0, 0.0, 159.5, 0.0, 300.0, 119.5, 0.0, 0.0, 1.0]\ndistortion_model: plumb_bob\n"
           "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.1, 0.02, 0.0, 0.0, 0.0]\n";
    // Looks along x, level, from 0.5 m above the floor.
    std::ofstream(scratch_ / "pose.csv") << "tx,ty,tz,qw,qx,qy,qz\n0.5,0,0.5,0.5,-0.5,0.5,-0.5\n";
  }

  [[nodiscard]] std::string at(const char* name) const { return scratch_ / name; }

  ScratchFolder scratch_;
};

TEST_F(MapCommand, InfoCountsWhatIsInIt) {
  const auto info = run_cgsr({"map", "info", at("map.obj"), "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.errors;
  const auto json = nlohmann::json::parse(info.output);
  EXPECT_EQ(json["surfaces"], 2);
  EXPECT_EQ(json["edges"], 8);
  EXPECT_EQ(json["edges_by_kind"]["border"], 8);
  EXPECT_EQ(json["borders_on_a_surface"], 1);
  EXPECT_GT(json["index"]["bytes"], 0);
  const auto text = run_cgsr({"map", "info", at("map.obj")});
  EXPECT_THAT(text.output, HasSubstr("surfaces  2 of 4 triangles"));
  EXPECT_THAT(text.output, HasSubstr("material  white  0.900"));
}

TEST_F(MapCommand, ImportWritesACopyThatIsTheSame) {
  const auto import = run_cgsr({"map", "import", at("map.obj"), "--output", at("copy.cgsrmap")});
  ASSERT_EQ(import.exit_code, 0) << import.errors;
  auto of_file = nlohmann::json::parse(run_cgsr({"map", "info", at("map.obj"), "--json"}).output);
  auto of_copy = nlohmann::json::parse(run_cgsr({"map", "info", at("copy.cgsrmap"), "--json"}).output);
  for (auto* json : {&of_file, &of_copy}) {
    json->erase("file");
    (*json)["index"].erase("build_ms");
  }
  EXPECT_EQ(of_file, of_copy);
  const auto wrong = run_cgsr({"map", "import", at("map.obj"), "--output", at("copy.obj")});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.errors, HasSubstr("to end in .cgsrmap"));
}

TEST_F(MapCommand, RenderAndOverlayDrawWhatTheCameraSees) {
  const auto render = run_cgsr({"map", "render", at("map.obj"), "--camera", at("camera.yaml"), "--pose", at("pose.csv"),
                                "--output", at("view.png")});
  ASSERT_EQ(render.exit_code, 0) << render.errors;
  const cv::Mat view = cv::imread(at("view.png"));
  ASSERT_EQ(view.size(), cv::Size(320, 240));
  EXPECT_GT(view.at<cv::Vec3b>(120, 160)[0], 200) << "the board";
  EXPECT_NEAR(view.at<cv::Vec3b>(235, 160)[0], 0.4 * 255 * 0.75, 20) << "the floor";
  // The board's upper edge: 0.5 m up at 2.5 m is 60 px above the middle, a little less through the lens.
  const cv::Mat black = cv::Mat::zeros(240, 320, CV_8UC3);
  cv::imwrite(at("black.png"), black);
  const auto overlay = run_cgsr({"map", "overlay", at("map.obj"), "--camera", at("camera.yaml"), "--pose",
                                 at("pose.csv"), "--image", at("black.png"), "--output", at("over.png")});
  ASSERT_EQ(overlay.exit_code, 0) << overlay.errors;
  const cv::Mat over = cv::imread(at("over.png"));
  int brightest = 0;
  for (int row = 20; row < 119; ++row) {
    if (over.at<cv::Vec3b>(row, 160)[2] > over.at<cv::Vec3b>(brightest, 160)[2]) brightest = row;
  }
  EXPECT_NEAR(brightest, 119.5 - 60.0 * (1.0 - 0.1 * 0.04), 1.5);
}

/// A wall of 2 m, a cell thick, as map_server stores it.
class RosMap : public MapCommand {
 protected:
  RosMap() {
    cv::Mat image(30, 60, CV_8U, cv::Scalar(254));
    image(cv::Rect(10, 10, 40, 1)) = 0;
    cv::imwrite(at("floor.pgm"), image);
  }

  void write_yaml(const std::string& text) { std::ofstream(scratch_ / "floor.yaml") << text; }
  Outcome import() {
    return run_cgsr(
        {"map", "import", at("floor.yaml"), "--wall-height", "2", "--output", at("floor.cgsrmap"), "--force"});
  }
};

TEST_F(RosMap, OccupiedCellsBecomeWalls) {
  write_yaml(
      "image: floor.pgm\nresolution: 0.05\norigin: [1.0, 2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: "
      "0.2\n");
  const auto done = import();
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("walls     1 of 2.0 m in all; 100.0 % of 40 border cells"));
  const auto json = nlohmann::json::parse(run_cgsr({"map", "info", at("floor.cgsrmap"), "--json"}).output);
  EXPECT_EQ(json["surfaces"], 1);
  EXPECT_EQ(json["edges"], 4);

  const auto no_height = run_cgsr({"map", "import", at("floor.yaml"), "--output", at("floor.cgsrmap")});
  EXPECT_EQ(no_height.exit_code, 1);
  EXPECT_THAT(no_height.errors, HasSubstr("expected --wall-height METRES"));
}

TEST_F(RosMap, ANegatedImageIsOccupiedWhereItIsLight) {
  write_yaml("image: floor.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 1\noccupied_thresh: 0.65\n");
  const auto done = import();
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("% of the walls at an occupied cell"));
}

TEST_F(RosMap, WhatIsWrongIsNamedWithItsLine) {
  const std::string rest = "origin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n";
  write_yaml("image: floor.pgm\n" + rest);
  EXPECT_THAT(import().errors,
              HasSubstr("floor.yaml: there is no 'resolution': expected the side of a cell in metres"));
  write_yaml("image: floor.pgm\nresolution: 50\n" + rest);
  EXPECT_THAT(import().errors, HasSubstr("floor.yaml:2: resolution is 50: expected 0.001..1 m"));
  write_yaml("image: none.pgm\nresolution: 0.05\n" + rest);
  EXPECT_THAT(import().errors, HasSubstr("none.pgm: no image that can be read"));
  write_yaml("image: ../../etc/passwd\nresolution: 0.05\n" + rest);
  EXPECT_THAT(import().errors, HasSubstr("lies outside of the map's folder"));
  write_yaml("image: floor.pgm\nresolution: 0.05\nmode: raw\n" + rest);
  EXPECT_THAT(import().errors, HasSubstr("floor.yaml:3: mode is 'raw': expected trinary"));
  write_yaml("image: floor.pgm\nresolution: 0.05\norigin: [0, 0]\nnegate: 0\noccupied_thresh: 0.65\n");
  EXPECT_THAT(import().errors, HasSubstr("floor.yaml:3: origin holds '[...]': expected [x, y, yaw]"));
  write_yaml("[1, 2");
  EXPECT_THAT(import().errors, HasSubstr("floor.yaml:"));
  EXPECT_EQ(import().exit_code, 1);
}

TEST_F(MapCommand, WhatIsWrongIsNamed) {
  EXPECT_THAT(run_cgsr({"map", "info", at("none.obj")}).errors, HasSubstr("none.obj: No such file"));
  EXPECT_THAT(run_cgsr({"map", "info", at("camera.yaml")}).errors, HasSubstr("no kind of map that is read"));
  EXPECT_EQ(run_cgsr({"map", "info", at("map.obj"), "--up", "x"}).exit_code, 2);
  cv::imwrite(at("small.png"), cv::Mat::zeros(10, 10, CV_8UC3));
  const auto size = run_cgsr({"map", "overlay", at("map.obj"), "--camera", at("camera.yaml"), "--pose", at("pose.csv"),
                              "--image", at("small.png"), "--output", at("over.png")});
  EXPECT_EQ(size.exit_code, 1);
  EXPECT_THAT(size.errors, HasSubstr("10x10 px, but"));
}

}  // namespace
}  // namespace cgsr::app::testing
