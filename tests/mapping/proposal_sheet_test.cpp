// Proposals drawn into the images of the drive, for a person to accept.
#include "tools/map/proposal_sheet.h"

#include <array>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/mapping/furnished_room.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::app {
namespace {

/// How many pixels are nearly as yellow as a proposal.
int drawn_px(const cv::Mat& bgr) {
  cv::Mat yellow;
  cv::inRange(bgr, cv::Scalar(0, 190, 220), cv::Scalar(90, 255, 255), yellow);
  return cv::countNonZero(yellow);
}

geometry::Pose looking_along_x() {
  geometry::Pose X_WC = geometry::Pose::Identity();
  X_WC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return X_WC;
}

TEST(DrawLine, IsWhereTheCameraSeesIt) {
  const geometry::Camera camera = mapping::testing::small_camera();
  cv::Mat picture = cv::Mat::zeros(camera.height_px, camera.width_px, CV_8UC3);

  draw_line({2.0, 0.3, 0.0}, {2.0, -0.3, 0.0}, looking_along_x(), camera, picture);

  cv::Mat drawn;
  cv::inRange(picture, cv::Scalar(0, 190, 220), cv::Scalar(90, 255, 255), drawn);
  const cv::Rect box = cv::boundingRect(drawn);
  EXPECT_NEAR(box.width, 0.6 / 2.0 * camera.fx_px, 4.0);
  EXPECT_NEAR(box.y + 0.5 * box.height, camera.cy_px, 2.0);
  EXPECT_NEAR(box.x + 0.5 * box.width, camera.cx_px, 2.0);
}

TEST(DrawLine, LeavesOutWhatIsBehindTheCamera) {
  const geometry::Camera camera = mapping::testing::small_camera();
  cv::Mat picture = cv::Mat::zeros(camera.height_px, camera.width_px, CV_8UC3);

  draw_line({-2.0, 0.3, 0.0}, {-2.0, -0.3, 0.0}, looking_along_x(), camera, picture);

  EXPECT_EQ(drawn_px(picture), 0);
}

class ProposalSheet : public ::testing::Test {
 protected:
  ProposalSheet() {
    std::filesystem::create_directories(folder_ / "drive");
    for (int i = 0; i < 3; ++i) {
      const cv::Mat grey(camera.height_px, camera.width_px, CV_8UC3, cv::Scalar::all(60 + 40 * i));
      cv::imwrite((folder_ / ("drive/" + std::to_string(i) + ".png")).string(), grey);
      views[static_cast<std::size_t>(i)].number = i;
      views[static_cast<std::size_t>(i)].X_WC = looking_along_x();
    }
    proposal.a = {2.0, 0.3, 0.0};
    proposal.b = {2.0, -0.3, 0.0};
    proposal.images = 12;
    proposal.best_view = 2;
  }
  [[nodiscard]] std::string drive() const { return (folder_ / "drive").string(); }

  geometry::Camera camera = mapping::testing::small_camera();
  std::array<mapping::View, 3> views;
  mapping::Proposal proposal;

 private:
  test::ScratchFolder folder_;
};

TEST_F(ProposalSheet, ShowsEachOneInTheImageThatShowsItLongest) {
  const std::array four{proposal, proposal, proposal, proposal};

  const auto sheet = proposal_sheet(four, views, camera, drive());

  ASSERT_TRUE(sheet) << sheet.error().message;
  const int cell_width_px = sheet->cols / 3, cell_height_px = sheet->rows / 2;
  for (int i = 0; i < 4; ++i) {
    const cv::Mat cell =
        (*sheet)(cv::Rect(i % 3 * cell_width_px, i / 3 * cell_height_px, cell_width_px, cell_height_px));
    EXPECT_GT(drawn_px(cell), 100) << i;
    EXPECT_NEAR(cell.at<cv::Vec3b>(cell_height_px - 5, 5)[0], 140, 6) << "image 2";
  }
  const cv::Mat free = (*sheet)(cv::Rect(cell_width_px, cell_height_px, cell_width_px, cell_height_px));
  EXPECT_EQ(drawn_px(free), 0) << "four of six places are taken";
}

TEST_F(ProposalSheet, SaysThatADriveHasBecomeShorter) {
  views[2].number = 7;

  const auto sheet = proposal_sheet({&proposal, 1}, views, camera, drive());

  ASSERT_FALSE(sheet);
  EXPECT_NE(sheet.error().message.find("image 3 cannot be read again"), std::string::npos) << sheet.error().message;
}

}  // namespace
}  // namespace cgsr::app
