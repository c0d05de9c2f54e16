#include "src/input/pose_pairs.h"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/world/scratch.h"

namespace cgsr::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class PosePairsFile : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string file = (scratch_ / name).string();
    std::ofstream(file) << text;
    return file;
  }

 private:
  world::ScratchFolder scratch_;
};

TEST_F(PosePairsFile, RowsOfTheSameFrameBelongTogether) {
  const std::string odometry =
      write("odometry.csv", "frame,tx,ty,tz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n2,2,0,0,1,0,0,0\n3,3,0,0,1,0,0,0\n");
  const std::string camera =
      write("camera.csv", "frame,tx,ty,tz,qw,qx,qy,qz\n1,11,0,0,1,0,0,0\n2,12,0,0,1,0,0,0\n3,13,0,0,1,0,0,0\n");
  const auto pairs = read_pairs(odometry, camera);
  ASSERT_TRUE(pairs) << pairs.error().message;
  EXPECT_THAT(pairs->frames, ElementsAre(2, 3));
  EXPECT_EQ(pairs->first[0].translation().x(), 2.0);
  EXPECT_EQ(pairs->second[0].translation().x(), 12.0);
  EXPECT_EQ(pairs->predicted, 0);
}

// What cgsr localize only carried on is where odometry says it is: it would confirm whatever is calibrated by it.
TEST_F(PosePairsFile, PredictionsAreLeftOutWhicheverFileHoldsThem) {
  const std::string odometry =
      write("odometry.csv",
            "frame,tx,ty,tz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,1,0,0,1,0,0,0\n2,2,0,0,1,0,0,0\n3,3,0,0,1,0,0,0\n");
  const std::string camera = write("camera.csv",
                                   "frame,corrected,reason,tx,ty,tz,qw,qx,qy,qz,matches,rms_px\n"
                                   "0,1,,10,0,0,1,0,0,0,9,0.4\n1,0,too few,11,0,0,1,0,0,0,1,0.0\n"
                                   "3,1,,13,0,0,1,0,0,0,9,0.4\n4,0,too few,14,0,0,1,0,0,0,1,0.0\n");
  for (const auto& [first, second] : {std::pair(odometry, camera), std::pair(camera, odometry)}) {
    const auto pairs = read_pairs(first, second);
    ASSERT_TRUE(pairs) << pairs.error().message;
    EXPECT_THAT(pairs->frames, ElementsAre(0, 3));
    EXPECT_EQ(pairs->predicted, 1);
  }
}

TEST_F(PosePairsFile, SaysWhyNothingIsLeft) {
  const std::string odometry = write("odometry.csv", "frame,tx,ty,tz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n");
  const std::string carried = write("carried.csv", "frame,corrected,tx,ty,tz,qw,qx,qy,qz\n0,0,0,0,0,1,0,0,0\n");
  const std::string later = write("later.csv", "frame,tx,ty,tz,qw,qx,qy,qz\n9,0,0,0,1,0,0,0\n");
  const std::string nameless = write("nameless.csv", "tx,ty,tz,qw,qx,qy,qz\n0,0,0,1,0,0,0\n");
  EXPECT_THAT(read_pairs(carried, odometry).error().message, HasSubstr("corrected is 0 in each"));
  EXPECT_THAT(read_pairs(odometry, later).error().message, HasSubstr("no frame number in common"));
  EXPECT_THAT(read_pairs(odometry, nameless).error().message, HasSubstr("nameless.csv: no column 'frame'"));
}

}  // namespace
}  // namespace cgsr::app
