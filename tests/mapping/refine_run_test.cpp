#include "tools/map/refine_run.h"

#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/mapping/furnished_room.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::app {
namespace {

using ::testing::HasSubstr;

class RefineRun : public ::testing::Test {
 protected:
  RefineRun() {
    write("room.obj", mapping::testing::room_as_obj());
    write("poses.csv", "frame,tx,ty,tz,qw,qx,qy,qz\n0,0,0,1,1,0,0,0\n");
    write("camera.yaml",
          "image_width: 640\nimage_height: 480\ncamera_matrix: {rows: 3, cols: 3, data: [600, 0, 319.5, 0, 600, 239.5, "
          "0, 0, 1]}\n"
          "distortion_model: plumb_bob\ndistortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n");
    options.map = path("room.obj");
    options.camera = path("camera.yaml");
    options.poses = path("poses.csv");
    options.input = path("images");
    options.output = path("refined.obj");
  }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string error() {
    const auto done = run_refine(options);
    return done ? "" : done.error().message;
  }

  RefineOptions options;

 private:
  test::ScratchFolder folder_;
};

TEST_F(RefineRun, NeverWritesOverItsMap) {
  options.force = true;
  options.output = options.map;
  EXPECT_THAT(error(), HasSubstr("room.obj"));
  std::stringstream text;
  text << std::ifstream(path("room.obj")).rdbuf();
  EXPECT_EQ(text.str(), mapping::testing::room_as_obj());
}

TEST_F(RefineRun, SaysWhatIsWrongAndWhere) {
  write("room.obj", "o a\nv 0 0 0\nv 1 0 0\nv 0 x 0\nf 1 2 3\n");
  EXPECT_THAT(error(), HasSubstr("room.obj:4: a coordinate is 'x': expected a finite number"));
  write("room.obj", mapping::testing::room_as_obj());
  EXPECT_THAT(error(), HasSubstr("images"));
  write("poses.csv", "frame,tx,ty,tz,qw,qx,qy,qz\n0,0,0,1,1,0,0\n");
  EXPECT_THAT(error(), HasSubstr("poses.csv:2: has 7 values"));
}

}  // namespace
}  // namespace cgsr::app
