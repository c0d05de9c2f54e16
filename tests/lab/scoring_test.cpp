#include "tools/lab/scoring.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace cgsr::lab {
namespace {

std::filesystem::path written(const test::ScratchFolder& scratch, const std::string& name, const std::string& text) {
  const auto path = scratch / name;
  std::ofstream(path) << text;
  return path;
}

TEST(ScoreImage, OverlapIsSharedByEachBoxInItsOwnWay) {
  const ImageScore score = score_image({10, 10, 40, 20}, Box{30, 10, 40, 20});

  EXPECT_DOUBLE_EQ(score.precision, 0.5);
  EXPECT_DOUBLE_EQ(score.recall, 0.5);
  EXPECT_DOUBLE_EQ(score.iou, 400.0 / 1200.0);
  EXPECT_FALSE(score.success);
  EXPECT_TRUE(score.found);
}

// Eq. 3.2 is asymmetric: a tiny box inside the object is precise, and only recall and IoU see that it is tiny.
TEST(ScoreImage, ATinyBoxInsideIsPreciseAndNothingElse) {
  const ImageScore score = score_image({0, 0, 10, 10}, Box{2, 2, 4, 4});

  EXPECT_DOUBLE_EQ(score.precision, 1.0);
  EXPECT_DOUBLE_EQ(score.recall, 0.16);
  EXPECT_DOUBLE_EQ(score.iou, 0.16);
}

TEST(ScoreImage, BoxesThatDoNotMeetScoreZeroButCountAsFound) {
  const ImageScore score = score_image({0, 0, 10, 10}, Box{10, 0, 5, 5});

  EXPECT_EQ(score.precision, 0.0);
  EXPECT_TRUE(score.found);
}

TEST(ScoreImage, NothingFoundOrABoxWithoutAreaScoresNothing) {
  EXPECT_FALSE(score_image({0, 0, 10, 10}, std::nullopt).found);
  EXPECT_FALSE(score_image({0, 0, 10, 10}, Box{1, 1, 0, 5}).found);
}

TEST(Score, AMissingDetectionCountsZeroAndAnAbsentObjectCountsNotAtAll) {
  const Box a{0, 0, 10, 10};
  const Boxes truth{a, a, std::nullopt, std::nullopt};
  const Boxes track{a, std::nullopt, a, std::nullopt};

  const Score mean = score(track, truth);

  EXPECT_EQ(mean.images, 2);
  EXPECT_DOUBLE_EQ(mean.precision, 0.5);
  EXPECT_DOUBLE_EQ(mean.found, 0.5);
  EXPECT_DOUBLE_EQ(mean.success, 0.5);
  EXPECT_EQ(mean.found_when_absent, 1);
}

TEST(Score, ATrackThatEndsEarlyIsNotFoundAfterwards) {
  const Box a{0, 0, 10, 10};

  const Score mean = score({a}, {a, a, a, a});

  EXPECT_EQ(mean.images, 4);
  EXPECT_DOUBLE_EQ(mean.recall, 0.25);
}

TEST(Score, NothingVisibleIsZeroNotNaN) {
  EXPECT_EQ(score({}, {std::nullopt}).precision, 0.0);
}

TEST(ReadTruth, TakesEverySeparatorPolygonsAndWhatIsNotVisible) {
  const test::ScratchFolder scratch;
  const auto truth = read_truth(written(scratch, "truth_separators.txt",
                                        "10,20,30,40\n10\t20\t30\t40\n10 20  30 40\n 10; 20; 30; 40 \r\n"
                                        "5,5,15,6,14,16,4,15\n"
                                        "nan,nan,nan,nan\n5,5,0,5\n\nnan nan nan nan\n 0 0 0 0\n"));

  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->size(), 10U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ((*truth)[i], (Box{10, 20, 30, 40})) << i;
  EXPECT_EQ((*truth)[4], (Box{4, 5, 11, 11}));
  for (std::size_t i = 5; i < 10; ++i) EXPECT_FALSE((*truth)[i]) << i;
}

TEST(ReadTruth, RefusesWhatIsNoListOfBoxesAndNamesTheLine) {
  const test::ScratchFolder scratch;
  for (const std::string line :
       {"no box", "1,2,3", "1,2,3,4,5", "1,2,3,4,5,6,7,8,9", "\xff\xd8\xff\xe0 JFIF", "frame,x,y,w"}) {
    const auto truth = read_truth(written(scratch, "truth_wrong.txt", "10,20,30,40\n" + line + "\n10,20,30,40\n"));
    ASSERT_FALSE(truth) << line;
    EXPECT_NE(truth.error().message.find("truth_wrong.txt:2: '"), std::string::npos) << truth.error().message;
  }
  EXPECT_FALSE(read_truth(written(scratch, "truth_empty.txt", ""))) << "no line at all";
  EXPECT_FALSE(read_truth(scratch / ".")) << "a folder";
}

TEST(ReadTruth, HasALineForEachImage) {
  const Boxes truth{Box{1, 2, 3, 4}, std::nullopt, Box{1, 2, 3, 4}, std::nullopt};
  EXPECT_FALSE(app::check_length("t", truth, 5));
  EXPECT_TRUE(app::check_length("t", truth, 4));
  EXPECT_TRUE(app::check_length("t", truth, 3)) << "a blank line at the end";
  EXPECT_FALSE(app::check_length("t", truth, 2));
}

TEST(ReadTruth, NamesTheFileThatIsNotThere) {
  const auto truth = read_truth("/nowhere/groundtruth.txt");

  ASSERT_FALSE(truth);
  EXPECT_NE(truth.error().message.find("/nowhere/groundtruth.txt"), std::string::npos);
}

TEST(ReadTrack, SkipsTheHeaderAndTakesMissingImagesAsNotFound) {
  const test::ScratchFolder scratch;
  const auto track = read_track(
      written(scratch, "track_rows.csv",
              "frame,found,x,y,width,height,divergence\n"
              "0,1,10,10,40,20,0.1\n2,0,10,10,40,20\n3.0,1,2,2,4,4\n5,0,,,,\n6,1,nan,1,1,1\n7,1,1,1,-1,1\n8,1,1\n"));

  ASSERT_TRUE(track) << track.error().message;
  ASSERT_EQ(track->size(), 9U);
  EXPECT_EQ((*track)[0], (Box{10, 10, 40, 20}));
  EXPECT_EQ((*track)[3], (Box{2, 2, 4, 4}));
  for (std::size_t i : {1U, 2U, 4U, 5U, 6U, 7U, 8U}) EXPECT_FALSE((*track)[i]) << i;
}

// A whole case with every figure worked out by hand: visible are images 0 to 3 and 7; image 0 is hit, image 1 by half, 2 and 7 are
// missed, 3 is a small box inside; image 4 holds a box where nothing is visible.
TEST(ScoreGolden, HandMadeCase) {
  const test::ScratchFolder scratch;
  const auto truth = read_truth(written(scratch, "truth_golden.txt",
                                        "10,10,40,20\n10\t10\t40\t20\n10 10 40 20\n0,0,10,0,10,10,0,10\n"
                                        "nan,nan,nan,nan\n5,5,0,5\n\n20,20,10,10\n"));
  const auto track =
      read_track(written(scratch, "track_golden.csv",
                         "frame,found,x,y,width,height,divergence\n0,1,10,10,40,20,0.1\n1,1,30,10,40,20,0.1\n"
                         "2,0,10,10,40,20\n3,1,2,2,4,4\n4,1,1,1,5,5\n5,0,,,,\n7,1,nan,1,1,1\n"));
  ASSERT_TRUE(truth && track);

  const Score all = score(*track, *truth);
  const Score without_first = score(*track, *truth, 1);

  EXPECT_EQ(all.images, 5);
  EXPECT_DOUBLE_EQ(all.precision, (1 + 0.5 + 0 + 1 + 0) / 5);
  EXPECT_DOUBLE_EQ(all.recall, (1 + 0.5 + 0 + 0.16 + 0) / 5);
  EXPECT_DOUBLE_EQ(all.iou, (1 + 1.0 / 3 + 0 + 0.16 + 0) / 5);
  EXPECT_DOUBLE_EQ(all.success, 0.2);
  EXPECT_DOUBLE_EQ(all.found, 0.6);
  EXPECT_EQ(all.found_when_absent, 1);
  EXPECT_EQ(without_first.images, 4);
  EXPECT_DOUBLE_EQ(without_first.precision, 1.5 / 4);
}

}  // namespace
}  // namespace cgsr::lab
