#include "pipeline/calibration/board.h"

#include <gtest/gtest.h>

#include "tests/calibration/board_pictures.h"

namespace cgsr::calibration {
namespace {

TEST(BoardGolden, CornersAreFoundInTheBoardsOwnOrderHoweverItIsTurned) {
  std::mt19937 random(1);
  const Board board{7, 4, 0.03};
  const geometry::Camera camera = testing::true_camera();
  const testing::Photographs photographs(camera);
  for (const double turn : {0.0, 1.5708, 3.1416}) {
    geometry::Pose X_CB = testing::board_before_camera(random, board, camera, 0.5, 0.5, 0.45);
    const Eigen::Vector3d middle_B(0.5 * (board.columns - 1) * board.square_m, 0.5 * (board.rows - 1) * board.square_m,
                                   0.0);
    const Eigen::Vector3d middle_C = X_CB * middle_B;
    X_CB.linear() = X_CB.linear() * geometry::rotation_of({0.0, 0.0, turn});
    X_CB.translation() = middle_C - X_CB.linear() * middle_B;
    const auto truth = testing::corners_of(X_CB, board, camera);
    ASSERT_FALSE(truth.empty());
    const auto found = find_board(photographs.of(X_CB, board, random), board);
    ASSERT_TRUE(found) << turn;
    double squares = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const cv::Point2d off = cv::Point2d((*found)[i]) - cv::Point2d(truth[i]);
      squares += off.dot(off);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(truth.size())), 0.15) << turn;
  }
}

// A board that was cut out along its squares, on a dark table: the quick search of OpenCV finds none of these.
TEST(BoardGolden, IsFoundWithoutAWhiteMargin) {
  std::mt19937 random(1);
  const Board board{7, 4, 0.03};
  const geometry::Camera camera = testing::true_camera();
  const testing::Photographs photographs(camera);
  for (int trial = 0; trial < 3; ++trial) {
    const geometry::Pose X_CB = testing::board_before_camera(random, board, camera, 0.5, 0.5, 0.45);
    const auto truth = testing::corners_of(X_CB, board, camera);
    ASSERT_FALSE(truth.empty());
    constexpr double kMargin = 0.0;
    constexpr double kTable = 20.0;
    const auto found = find_board(photographs.of(X_CB, board, random, kMargin, kTable), board);
    ASSERT_TRUE(found) << trial;
    for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_LT(cv::norm((*found)[i] - truth[i]), 0.5) << trial;
  }
}

TEST(BoardFault, NothingInAnEmptyImage) {
  EXPECT_FALSE(find_board(cv::Mat(240, 320, CV_8U, cv::Scalar(128)), Board{}));
}

TEST(BoardFault, WhatIsNoBoardIsNamed) {
  EXPECT_TRUE(parse_board("9x6", 0.02));
  for (const char* text : {"", "9", "9x", "x6", "2x6", "9x99", "9x6x", "nine"}) {
    const auto board = parse_board(text, 0.02);
    ASSERT_FALSE(board) << text;
    EXPECT_NE(board.error().message.find("9x6"), std::string::npos);
  }
}

}  // namespace
}  // namespace cgsr::calibration
