#include "src/input/pose_file.h"

#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cgsr::app {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& text) {
  const auto rows = parse_poses(text, "poses.csv");
  return rows ? "" : rows.error().message;
}

TEST(PoseFile, ReadsColumnsByTheirNames) {
  const auto rows = parse_poses(
      "# from the lab\n"
      "\n"
      "frame,corrected,reason,tx,ty,tz,qw,qx,qy,qz,matches,rms_px\r\n"
      "3,1,,1.5,-2,0.25,0.5,0.5,-0.5,0.5,12,0.4\r\n"
      "7,0,too few matches,0,0,1,1,0,0,0,0,\r\n",
      "poses.csv");
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->size(), 2U);
  EXPECT_EQ(rows->front().frame, 3);
  EXPECT_EQ(rows->front().line, 4);
  EXPECT_EQ(rows->front().X.translation(), Eigen::Vector3d(1.5, -2.0, 0.25));
  const Eigen::Quaterniond q(0.5, 0.5, -0.5, 0.5);
  EXPECT_LT((rows->front().X.linear() - q.toRotationMatrix()).norm(), 1e-12);
  EXPECT_EQ(rows->back().frame, 7);
  EXPECT_TRUE(rows->front().corrected);
  EXPECT_FALSE(rows->back().corrected);
}

TEST(PoseFile, NeedsNoFrameColumnAndNoLastLineFeed) {
  const auto rows = parse_poses("tx,ty,tz,qw,qx,qy,qz\n0, 0, 1, 1, 0, 0, 0", "poses.csv");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_FALSE(rows->front().frame);
}

TEST(PoseFile, TakesHowWellAPoseIsKnownWhereTheFileSaysSo) {
  const auto rows =
      parse_poses("tx,ty,tz,qw,qx,qy,qz,sigma_m,sigma_deg\n0,0,1,1,0,0,0,0.02,90\n0,0,1,1,0,0,0,,\n", "poses.csv");
  ASSERT_TRUE(rows) << rows.error().message;
  EXPECT_EQ(rows->front().sigma_m, 0.02);
  EXPECT_NEAR(rows->front().sigma_rad.value_or(0.0), 1.5707963, 1e-6);
  EXPECT_FALSE(rows->back().sigma_m);
  EXPECT_FALSE(rows->back().sigma_rad);
  EXPECT_THAT(refusal("tx,ty,tz,qw,qx,qy,qz,sigma_m\n0,0,1,1,0,0,0,-1\n"), HasSubstr("sigma_m is '-1'"));
}

TEST(PoseFileProperty, WhatIsWrittenReadsBack) {
  std::mt19937 random(7);
  const auto unit = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  for (int i = 0; i < 200; ++i) {
    geometry::Pose X = geometry::Pose::Identity();
    X.translation() = 50.0 * Eigen::Vector3d(unit(), unit(), unit());
    X.linear() = Eigen::Quaterniond(unit(), unit(), unit(), unit()).normalized().toRotationMatrix();
    const auto rows = parse_poses(std::string(kPoseColumns) + "\n" + pose_as_csv(X) + "\n", "poses.csv");
    ASSERT_TRUE(rows) << rows.error().message;
    EXPECT_LT((rows->front().X.translation() - X.translation()).norm(), 1e-6);
    EXPECT_LT((rows->front().X.linear() - X.linear()).norm(), 1e-7);
  }
}

TEST(PoseFileFault, NamesLineValueAndWhatWasExpected) {
  const std::string head = "frame,tx,ty,tz,qw,qx,qy,qz\n";
  EXPECT_THAT(refusal(""), HasSubstr("poses.csv: is empty: expected the header"));
  EXPECT_THAT(refusal(head), HasSubstr("holds no pose"));
  EXPECT_THAT(refusal("1,2,3,1,0,0,0\n"), StartsWith("poses.csv:1: the header '1,2,3,1,0,0,0' has no column 'tx'"));
  EXPECT_THAT(refusal("tx,ty,tz,qw,qx,qy\n"), HasSubstr("has no column 'qz'"));
  EXPECT_THAT(refusal("tx,tx,ty,tz,qw,qx,qy,qz\n"), HasSubstr("column 'tx' is there twice"));
  EXPECT_EQ(refusal(head + "0,1,2,3,1,0,0\n"), "poses.csv:2: has 7 values: expected 8, as the header has");
  EXPECT_THAT(refusal(head + "0,1,2,three,1,0,0,0\n"), HasSubstr("poses.csv:2: tz is 'three'"));
  EXPECT_THAT(refusal(head + "0,1,2,nan,1,0,0,0\n"), HasSubstr("expected a finite number"));
  EXPECT_THAT(refusal(head + "0,1,2,,1,0,0,0\n"), HasSubstr("tz is ''"));
  EXPECT_THAT(refusal(head + "0,1,2,1e300,1,0,0,0\n"), HasSubstr("tz is 1e+300 m"));
  EXPECT_THAT(refusal(head + "0,1,2,3,0,0,0,0\n"), HasSubstr("has the length 0: expected 1"));
  EXPECT_THAT(refusal(head + "0,1,2,3,1,1,0,0\n"), HasSubstr("has the length 1.41421"));
  EXPECT_THAT(refusal(head + "-1,1,2,3,1,0,0,0\n"), HasSubstr("frame is '-1'"));
  EXPECT_THAT(refusal(head + "1.5,1,2,3,1,0,0,0\n"), HasSubstr("frame is '1.5'"));
  EXPECT_THAT(refusal("corrected,tx,ty,tz,qw,qx,qy,qz\nyes,0,0,1,1,0,0,0\n"),
              HasSubstr("poses.csv:2: corrected is 'yes': expected 1"));
  EXPECT_THAT(refusal(head + "4,1,2,3,1,0,0,0\n4,1,2,3,1,0,0,0\n"),
              HasSubstr("poses.csv:3: frame is 4 after 4: expected rising numbers"));
}

TEST(PoseFileFault, SaysWhyAFileCannotBeRead) {
  EXPECT_THAT(read_poses("/nowhere/poses.csv").error().message, HasSubstr("/nowhere/poses.csv: cannot be read"));
  EXPECT_THAT(read_pose("/").error().message, HasSubstr("is a folder"));
}

}  // namespace
}  // namespace cgsr::app
