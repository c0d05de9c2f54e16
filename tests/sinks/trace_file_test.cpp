#include "src/sinks/trace_file.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "tests/sinks/trace_check.h"

namespace cgsr::sinks {
namespace {

using test::check_trace;
using test::check_trace_file;
using test::TraceContents;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

constexpr int kVision = 1;
constexpr int kMotion = 2;

MonoTime at_us(double us) {
  return MonoTime{Duration{static_cast<std::int64_t>(us * 1000.0)}};
}
Duration us(double us) {
  return at_us(us).time_since_epoch();
}

class TraceFileTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) / (std::string("trace_") + test->name() + ".json");
  }
  void TearDown() override { std::filesystem::remove(path_); }

  TraceFile create() {
    auto trace = TraceFile::create(path_, "cgsr");
    EXPECT_TRUE(trace) << trace.error().message;
    EXPECT_TRUE(trace->name_thread(kVision, "vision"));
    EXPECT_TRUE(trace->name_thread(kMotion, "motion"));
    return std::move(*trace);
  }

  std::string text() {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // A trace of one event that must not be there.
  std::vector<std::string> problems_of(TraceFile& trace) {
    EXPECT_TRUE(trace.close());
    return check_trace_file(path_).problems;
  }

  std::filesystem::path path_;
};

// As a run writes it: per image a slice with its stages inside and a hand-over to motion.
void write_run(TraceFile& trace, int images) {
  for (int i = 0; i < images; ++i) {
    const double t = 33000.0 * i + 0.125;
    ASSERT_TRUE(trace.slice(kVision, "image", at_us(t), us(20000.5), {{"sequence", std::int64_t{i}}}));
    ASSERT_TRUE(trace.slice(kVision, "decode", at_us(t), us(900.25)));
    ASSERT_TRUE(
        trace.slice(kVision, "track", at_us(t + 900.25), us(7000.0), {{"cause", std::string_view("\"late\"")}}));
    ASSERT_TRUE(trace.instant(kVision, "skip localize", at_us(t + 8000.0)));
    ASSERT_TRUE(trace.flow_start(kVision, "goal", static_cast<std::uint64_t>(i), at_us(t + 20000.0)));
    ASSERT_TRUE(trace.begin(kMotion, "cycle", at_us(t + 21000.0)));
    ASSERT_TRUE(trace.flow_end(kMotion, "goal", static_cast<std::uint64_t>(i), at_us(t + 21000.0)));
    ASSERT_TRUE(trace.end(kMotion, at_us(t + 21100.0)));
    ASSERT_TRUE(trace.counter("speed", at_us(t), 0.1 * i));
  }
}

TEST_F(TraceFileTest, ARunIsSoundAndComplete) {
  TraceFile trace = create();
  write_run(trace, 50);
  ASSERT_TRUE(trace.close());
  EXPECT_TRUE(trace.close()) << "closing twice is no error";

  const TraceContents contents = check_trace_file(path_);

  EXPECT_THAT(contents.problems, IsEmpty());
  EXPECT_THAT(contents.slices,
              ElementsAre(Pair("cycle", 50), Pair("decode", 50), Pair("image", 50), Pair("track", 50)));
  EXPECT_THAT(contents.instants, ElementsAre(Pair("skip localize", 50)));
  EXPECT_THAT(contents.counters, ElementsAre(Pair("speed", 50)));
  EXPECT_THAT(contents.threads, ElementsAre(Pair(kVision, "vision"), Pair(kMotion, "motion")));
  EXPECT_EQ(contents.flows, 50);
}

TEST_F(TraceFileTest, StampsKeepTheirNanoseconds) {
  TraceFile trace = create();
  ASSERT_TRUE(trace.slice(kVision, "a", MonoTime{Duration{7'200'000'000'000'123}}, Duration{1001}));
  ASSERT_TRUE(trace.instant(kVision, "b", MonoTime{Duration{-5}}));
  ASSERT_TRUE(trace.close());
  EXPECT_THAT(text(), HasSubstr(R"("ts":7200000000000.123,"dur":1.001)"));
  EXPECT_THAT(text(), HasSubstr(R"("ts":-0.005)"));
}

TEST_F(TraceFileTest, AFileCutAnywhereIsReadableUpToTheCut) {
  TraceFile trace = create();
  write_run(trace, 20);
  ASSERT_TRUE(trace.close());
  const std::string whole = text();
  std::mt19937 random(20261123);
  for (int trial = 0; trial < 50; ++trial) {
    const auto cut = std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    const auto contents = check_trace(whole.substr(0, cut), true);
    EXPECT_THAT(contents.problems, IsEmpty()) << cut;
  }
}

TEST_F(TraceFileTest, WhatIsFlushedIsOnDisk) {
  TraceFile trace = create();
  write_run(trace, 1);
  ASSERT_TRUE(trace.flush());
  EXPECT_EQ(check_trace(text(), true).slices.at("image"), 1);
}

TEST_F(TraceFileTest, OverlapIsFound) {
  TraceFile trace = create();
  ASSERT_TRUE(trace.slice(kVision, "a", at_us(0), us(10)));
  ASSERT_TRUE(trace.slice(kVision, "b", at_us(9.999), us(10)));
  EXPECT_THAT(problems_of(trace), ElementsAre(HasSubstr("do not nest")));
}

TEST_F(TraceFileTest, SlicesThatTouchAreNoOverlap) {
  TraceFile trace = create();
  ASSERT_TRUE(trace.slice(kVision, "a", at_us(0), us(10)));
  ASSERT_TRUE(trace.slice(kVision, "b", at_us(10), us(10)));
  EXPECT_THAT(problems_of(trace), IsEmpty());
}

TEST_F(TraceFileTest, AMissingEndOrBeginIsFound) {
  TraceFile trace = create();
  ASSERT_TRUE(trace.begin(kVision, "a", at_us(0)));
  ASSERT_TRUE(trace.end(kMotion, at_us(1)));
  EXPECT_THAT(problems_of(trace), ElementsAre(HasSubstr("without a begin"), HasSubstr("never ends")));
}

TEST_F(TraceFileTest, TimeThatGoesBackIsFound) {
  TraceFile trace = create();
  ASSERT_TRUE(trace.instant(kVision, "a", at_us(2)));
  ASSERT_TRUE(trace.instant(kVision, "b", at_us(1)));
  ASSERT_TRUE(trace.counter("c", at_us(2), 0.0));
  ASSERT_TRUE(trace.counter("c", at_us(1), 0.0));
  EXPECT_THAT(problems_of(trace),
              ElementsAre(HasSubstr("thread 1: time goes back"), HasSubstr("counter c: time goes back")));
}

TEST_F(TraceFileTest, FlowsWithoutSliceOrWithOneEndAreFound) {
  TraceFile trace = create();
  ASSERT_TRUE(trace.slice(kVision, "a", at_us(0), us(10)));
  ASSERT_TRUE(trace.flow_start(kVision, "goal", 1, at_us(5)));
  ASSERT_TRUE(trace.flow_start(kVision, "goal", 2, at_us(5)));
  ASSERT_TRUE(trace.flow_end(kMotion, "goal", 2, at_us(6)));
  ASSERT_TRUE(trace.flow_end(kVision, "goal", 3, at_us(6)));
  EXPECT_THAT(problems_of(trace), ElementsAre(HasSubstr("goal 1 never ends"), HasSubstr("goal 2 ends in no slice"),
                                              HasSubstr("goal 3 ends and never starts")));
}

TEST_F(TraceFileTest, AFileThatCannotBeWrittenIsNamed) {
  const auto missing = TraceFile::create("/nowhere/at/all.json", "cgsr");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("/nowhere/at/all.json"));

  auto full = TraceFile::create("/dev/full", "cgsr");
  ASSERT_TRUE(full);
  const auto flushed = full->flush();
  ASSERT_FALSE(flushed);
  EXPECT_THAT(flushed.error().message, HasSubstr("/dev/full"));
  EXPECT_FALSE(full->instant(kVision, "a", at_us(0)));
  EXPECT_FALSE(full->close());
}

}  // namespace
}  // namespace cgsr::sinks
