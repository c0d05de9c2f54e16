// The demonstration stage of docs/guides/add-a-stage.md in a vision loop of its own: what it puts out appears in every sink, none of which
// knows it. Compiled against copies of the files that the lines of the page change (apply_lines.py).
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vision_loop.h"
#include "platform/clock.h"
#include "src/sinks/csv_sink.h"
#include "src/sinks/fan_out.h"
#include "src/sinks/recording_sink.h"
#include "src/sinks/statistics_sink.h"
#include "src/sinks/trace_sink.h"
#include "src/sinks/video_sink.h"
#include "tests/sinks/mcap_check.h"
#include "tests/sinks/trace_check.h"
#include "tests/support/scratch_folder.h"

namespace cgsr {
namespace {

using testing::HasSubstr;

constexpr int kImages = 6;
constexpr int kWidth_px = 320;
constexpr int kHeight_px = 240;
constexpr Duration kPeriod = seconds(1.0 / 30.0);

/// Images of one grey each: the n-th has luma 40 + 30 n.
class GreyCamera final : public ImageLender {
 public:
  ImageLease image(int number) {
    pixels_.assign(std::size_t{kWidth_px} * kHeight_px * 2, 128);
    for (std::size_t i = 0; i < pixels_.size(); i += 2) pixels_[i] = static_cast<std::uint8_t>(luma_of(number));
    const ImageView view{pixels_.data(), kWidth_px, kHeight_px, kWidth_px * 2, PixelFormat::kYuyv};
    return {*this, 0, view, static_cast<std::uint64_t>(number), MonoTime{number * kPeriod}};
  }
  static int luma_of(int number) { return 40 + 30 * number; }
  static double brightness_of(int number) { return (luma_of(number) - 16.0) / 219.0; }
  void give_back(int /*slot*/) noexcept override {}

 private:
  std::vector<std::uint8_t> pixels_;
};

class AddAStage : public testing::Test {
 protected:
  AddAStage() {
    VisionParts parts;
    parts.make<stages::DecodeStage>(stages::DecodeStage::Setup{kWidth_px, kHeight_px, {}});
    auto schedule = runtime::Schedule::make(runtime::rows_of(VisionStages{}), seconds(0.05));
    EXPECT_TRUE(schedule) << schedule.error().message;
    runner_ = std::make_unique<runtime::StageRunner>(clock_, *schedule, runtime::BudgetSource::kUnits, motion_stop_);
    loop_ = std::make_unique<VisionLoop>(*runner_, std::move(parts));
    EXPECT_TRUE(loop_->bind());
    schedule_ = std::make_unique<runtime::Schedule>(*schedule);
    add_sinks();
  }

  void add_sinks() {
    const hal::CameraMode mode{kWidth_px, kHeight_px, PixelFormat::kYuyv, kPeriod};
    sinks_.add(std::make_unique<sinks::StatisticsSink>(*schedule_));
    sinks_.add(std::move(*sinks::CsvSink::create(file("run.csv"), nullptr)));
    sinks_.add(std::move(*sinks::TraceSink::create(file("trace.json"), *schedule_)));
    sinks_.add(std::move(*sinks::RecordingSink::create(file("run.mcap"))));
    sinks_.add(std::move(*sinks::VideoSink::create(file("run.avi"), mode, *schedule_, nullptr, nullptr)));
  }

  void run() {
    GreyCamera camera;
    for (int i = 0; i < kImages; ++i) {
      const ImageLease image = camera.image(i);
      runner_->begin_frame({image.stamp(), image.sequence(), true});
      stages::FrameResult frame = loop_->on_image(image, {});
      frame.view.value = {};
      const sinks::Picture picture{camera.image(i), {}};
      const MotionStatus motion;
      const sinks::ImageReport report{frame, runner_->end_frame(), motion, &picture, image.stamp()};
      sinks_.on_image(report);
      lines_ = sinks::overlay_lines(report, *schedule_);
    }
    sinks_.finish();
    EXPECT_EQ(sinks_.problem(), "");
  }

  [[nodiscard]] std::string file(const std::string& name) const { return (scratch_ / name).string(); }

  test::ScratchFolder scratch_;
  RealClock clock_;
  runtime::MotionStop motion_stop_;
  std::unique_ptr<runtime::Schedule> schedule_;
  std::unique_ptr<runtime::StageRunner> runner_;
  std::unique_ptr<VisionLoop> loop_;
  sinks::FanOut sinks_;
  std::vector<std::string> lines_;  // below the last image
};

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  if (line.ends_with(',')) cells.emplace_back();
  return cells;
}

TEST_F(AddAStage, ItsOutputIsInEverySink) {
  run();
  const double last = GreyCamera::brightness_of(kImages - 1);

  std::ifstream csv(file("run.csv"));
  std::string header;
  std::string row;
  std::getline(csv, header);
  EXPECT_EQ(cells_of(header).back(), "mean_brightness") << "new columns are appended";
  int rows = 0;
  for (; std::getline(csv, row); ++rows) {
    ASSERT_EQ(cells_of(row).size(), cells_of(header).size());
    EXPECT_NEAR(std::stod(cells_of(row).back()), GreyCamera::brightness_of(rows), 0.001);
  }
  EXPECT_EQ(rows, kImages);

  const auto summary = sinks_.summary().json;
  EXPECT_NEAR(summary.at("outputs").at("brightness").at("last").at("mean_brightness").get<double>(), last, 1e-9);
  EXPECT_EQ(summary.at("outputs").at("brightness").at("updates"), kImages);
  EXPECT_EQ(summary.at("stages").at("brightness").at("runs"), kImages - 1) << "the first frame is not counted";

  EXPECT_THAT(lines_, testing::Contains(HasSubstr(fmt::format("brightness: mean_brightness {:.3f}", last))));
  EXPECT_GT(std::filesystem::file_size(file("run.avi")), 1000u);

  const auto trace = test::check_trace_file(file("trace.json"));
  EXPECT_THAT(trace.problems, testing::IsEmpty());
  EXPECT_EQ(trace.slices.at("brightness"), kImages);

  const auto recording = test::check_mcap(test::read_bytes(file("run.mcap")));
  EXPECT_THAT(recording.problems, testing::IsEmpty());
  EXPECT_EQ(recording.schemas.at("/cgsr/brightness"), "cgsr/brightness");
  EXPECT_EQ(std::ranges::count(recording.messages, "/cgsr/brightness", &test::McapMessage::topic), kImages);
}

}  // namespace
}  // namespace cgsr
