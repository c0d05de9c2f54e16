// The tracking benchmark in small: three recorded sequences, one pass.

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "tests/support/real_data.h"
#include "tests/support/scratch_folder.h"
#include "tools/lab/experiment.h"

namespace cgsr::lab {
namespace {

Setting small_setting(const test::ScratchFolder& folder) {
  Setting setting;
  setting.seed = 7;
  setting.count = false;
  setting.data = test::real_data("tracking").parent_path();
  setting.tracking.only = {"crossing", "deer", "dragonbaby"};
  setting.tracking.parts = {"one-pass"};
  setting.tracking.trackers = {"ours", "plain", "CAM-Shift", "KCF"};
  setting.tracking.images = 60;
  setting.tracking.output = (folder / "page").string();
  setting.tracking.cache = (folder / "cache").string();
  return setting;
}

double figure(const Report& report, const std::string& row, const std::string& quantity) {
  for (const Row& one : report.rows) {
    if (one.row == row && one.quantity == quantity) return one.ours.value_or(-1.0);
  }
  ADD_FAILURE() << "no row " << row << ", " << quantity;
  return -1.0;
}

TEST(TrackingBenchmark, OursHoldsOnThreeSequencesAndThePageIsThere) {
  CGSR_NEEDS_REAL_DATA("tracking/dragonbaby");
  const test::ScratchFolder folder;

  const auto report = measure(*experiment_of("tracking-benchmark"), small_setting(folder));

  ASSERT_TRUE(report) << report.error().message;
  EXPECT_GT(figure(*report, "one pass / ours", "AUC"), 0.35);
  EXPECT_GT(figure(*report, "one pass / KCF", "AUC"), 0.1);
  EXPECT_TRUE(std::filesystem::exists(folder / "page/index.html"));
  EXPECT_TRUE(std::filesystem::exists(folder / "page/figures.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "page/films/deer.mp4"));
}

TEST(TrackingBenchmark, BadInputIsRefusedInWords) {
  const test::ScratchFolder folder;
  Setting setting;
  setting.tracking.output = (folder / "page").string();
  EXPECT_FALSE(tracking_benchmark(setting)) << "no data";
  setting.tracking.sequences = {(folder / "nowhere").string()};
  const auto missing = tracking_benchmark(setting);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("nowhere"), std::string::npos);

  std::filesystem::create_directories(folder / "all/broken/img");
  std::ofstream(folder / "all/broken/img/0.jpg") << "no picture";
  std::ofstream(folder / "all/broken/groundtruth.txt") << "1,2,30,40\n";
  setting.tracking.sequences = {(folder / "all").string()};
  const auto unreadable = tracking_benchmark(setting);
  ASSERT_FALSE(unreadable);
  EXPECT_NE(unreadable.error().message.find("0.jpg"), std::string::npos) << unreadable.error().message;

  std::ofstream(folder / "all/broken/img/1.jpg") << "no picture";
  const auto short_truth = tracking_benchmark(setting);
  ASSERT_FALSE(short_truth);
  EXPECT_NE(short_truth.error().message.find("has 1 lines for 2 images"), std::string::npos)
      << short_truth.error().message;
}

TEST(TrackingBenchmark, TheRelitPartIsATableOfItsOwnWithOursMinusCsrt) {
  CGSR_NEEDS_REAL_DATA("tracking/deer");
  const test::ScratchFolder folder;
  Setting setting = small_setting(folder);
  setting.tracking.only = {"deer"};
  setting.tracking.trackers = {"ours", "CSRT"};
  setting.tracking.images = 8;
  setting.tracking.no_films = true;

  const auto report = measure(*experiment_of("tracking-relit"), setting);

  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->name, "tracking-relit");
  const double ours = figure(*report, "relit, steps / ours", "IoU");
  EXPECT_GT(ours, 0.3);
  EXPECT_NEAR(figure(*report, "relit, steps / ours minus CSRT", "IoU"),
              ours - figure(*report, "relit, steps / CSRT", "IoU"), 1e-9);
  for (const Row& row : report->rows) EXPECT_FALSE(row.row.starts_with("one pass")) << row.row;
}

TEST(TrackingBenchmark, TheCostPartIsNothingWithoutCounting) {
  Setting setting;
  setting.count = false;
  EXPECT_FALSE(tracking_cost(setting));
}

}  // namespace
}  // namespace cgsr::lab
