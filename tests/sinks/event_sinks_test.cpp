// Events of any output reach log, summary, trace and recording; the sinks know no stage by its name.
#include <array>

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include "src/sinks/event_text.h"
#include "src/sinks/log_sink.h"
#include "src/sinks/statistics_sink.h"
#include "src/sinks/trace_sink.h"
#include "tests/sinks/trace_check.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::sinks {
namespace {

using testing::HasSubstr;

/// A frame whose task changed its state and whose lamp was located.
stages::FrameResult frame_with_events() {
  stages::FrameResult frame;
  frame.decision.age = Duration::zero();
  frame.decision.value.state = "search";
  frame.decision.value.events.add({"task", "search", "the object is lost"});
  frame.lamp.age = Duration::zero();
  frame.lamp.value.events.add({"lamp", "located", {}, {{{"x", 1.25, "m"}, {"sigma", 0.03, "m"}}}, 2});
  return frame;
}

runtime::FrameRecord record_of(std::uint64_t image) {
  runtime::FrameRecord record;
  record.image_sequence = image;
  record.stamp = MonoTime{seconds(0.1 * static_cast<double>(image))};
  record.has_image = true;
  return record;
}

runtime::Schedule schedule() {
  return *runtime::Schedule::make({{"decide", {}}}, seconds(1.0 / 30.0));
}

/// What is logged while it lives.
class CapturedLog {
 public:
  CapturedLog() : before_(spdlog::default_logger()) {
    spdlog::set_default_logger(
        std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_st>(text_)));
  }
  ~CapturedLog() { spdlog::set_default_logger(before_); }
  CapturedLog(const CapturedLog&) = delete;
  CapturedLog& operator=(const CapturedLog&) = delete;

  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

TEST(EventText, HasReasonAndNumbers) {
  EXPECT_EQ(text_of({"task", "search", "the object is lost"}), "task: search: the object is lost");
  EXPECT_EQ(text_of({"lamp", "located", {}, {{{"x", 1.25, "m"}, {"pairs", 3.0, ""}}}, 2}),
            "lamp: located (x 1.25 m, pairs 3)");
}

TEST(Events, ThoseWithoutRoomAreCounted) {
  stages::Events events;
  for (std::size_t i = 0; i < stages::Events::kMaxEvents + 2; ++i) events.add({"task", "state", {}});
  EXPECT_EQ(events.size(), stages::Events::kMaxEvents);
  EXPECT_EQ(events.lost(), 2U);
}

TEST(LogSink, WritesTheEventsOfThisImageAlone) {
  const CapturedLog log;
  LogSink sink;
  const MotionStatus motion;
  stages::FrameResult frame = frame_with_events();
  ASSERT_TRUE(sink.on_image({frame, record_of(7), motion, nullptr}));
  EXPECT_THAT(log.text(), HasSubstr("image 7 (0.7 s): task: search: the object is lost"));
  EXPECT_THAT(log.text(), HasSubstr("lamp: located (x 1.25 m, sigma 0.03 m)"));

  frame.decision.age = frame.lamp.age = seconds(0.033);  // the stages did not run: what they said is old
  ASSERT_TRUE(sink.on_image({frame, record_of(8), motion, nullptr}));
  EXPECT_THAT(log.text(), testing::Not(HasSubstr("image 8")));
}

// A task may have more to say than there is room for: every reader of events hears that some are missing, of this image alone.
TEST(LogSink, TellsOfEventsWithoutRoom) {
  const CapturedLog log;
  LogSink sink;
  const MotionStatus motion;
  stages::FrameResult frame;
  frame.decision.age = Duration::zero();
  stages::Events& events = frame.decision.value.events;
  for (std::size_t i = 0; i < stages::Events::kMaxEvents; ++i) events.add({"task", "state", {}});
  ASSERT_TRUE(sink.on_image({frame, record_of(7), motion, nullptr}));
  EXPECT_THAT(log.text(), testing::Not(HasSubstr("events lost"))) << "all had room";

  for (int i = 0; i < 2; ++i) events.add({"task", "state", {}});
  ASSERT_TRUE(sink.on_image({frame, record_of(8), motion, nullptr}));
  EXPECT_THAT(log.text(), HasSubstr("image 8 (0.8 s): decision: events lost (count 2)"));

  frame.decision.age = seconds(0.033);
  ASSERT_TRUE(sink.on_image({frame, record_of(9), motion, nullptr}));
  EXPECT_THAT(log.text(), testing::Not(HasSubstr("image 9")));
}

TEST(StatisticsSink, KeepsEventsAndCountsWhatFieldsWere) {
  StatisticsSink sink(schedule());
  const MotionStatus motion;
  const stages::FrameResult with_events = frame_with_events();
  ASSERT_TRUE(sink.on_image({with_events, record_of(7), motion, nullptr}));
  stages::FrameResult frame;
  frame.decision.age = Duration::zero();
  frame.decision.value.state = "follow";
  for (std::uint64_t i = 8; i < 10; ++i) ASSERT_TRUE(sink.on_image({frame, record_of(i), motion, nullptr}));

  Summary summary;
  sink.summarize(summary);

  const auto& events = summary.json.at("events");
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0]["source"], "task");
  EXPECT_EQ(events[0]["reason"], "the object is lost");
  EXPECT_EQ(events[0]["image"], 7);
  EXPECT_EQ(events[1]["numbers"]["x"], 1.25);
  const auto& states = summary.json.at("outputs").at("decision").at("images").at("state");
  EXPECT_EQ(states["search"], 1);
  EXPECT_EQ(states["follow"], 2);
  EXPECT_EQ(summary.json["outputs"]["lamp"]["images"]["lamp_x_m"], 0) << "it was never there";
  EXPECT_THAT(summary.text, HasSubstr("decision, state by images: follow 2; search 1;"));
}

TEST(StatisticsSink, KeepsTheLastEventsOfALongRun) {
  StatisticsSink sink(schedule());
  const MotionStatus motion;
  const stages::FrameResult frame = frame_with_events();
  const std::uint64_t images = RunStatistics::kMaxEvents;
  for (std::uint64_t i = 0; i < images; ++i) ASSERT_TRUE(sink.on_image({frame, record_of(i), motion, nullptr}));
  EXPECT_EQ(sink.run().events.size(), RunStatistics::kMaxEvents);
  EXPECT_EQ(sink.run().earlier_events, images);
  EXPECT_EQ(sink.run().events.back().image, images - 1);
}

TEST(StatisticsSink, KeepsWhatWasSaidHoweverLongTheRun) {
  StatisticsSink sink(schedule());
  const MotionStatus motion;
  stages::FrameResult said;
  said.decision.age = Duration::zero();
  said.decision.value.events.add({"says", "I know you", {}});
  const stages::FrameResult frame = frame_with_events();
  ASSERT_TRUE(sink.on_image({said, record_of(0), motion, nullptr}));
  for (std::uint64_t i = 1; i <= RunStatistics::kMaxEvents; ++i)
    ASSERT_TRUE(sink.on_image({frame, record_of(i), motion, nullptr}));
  EXPECT_EQ(sink.run().events.size(), RunStatistics::kMaxEvents);
  EXPECT_EQ(sink.run().events.front().event.source, "says");
}

TEST(TraceSink, ShowsEventsAsInstants) {
  const test::ScratchFolder scratch;
  auto sink = std::move(*TraceSink::create((scratch / "trace.json").string(), schedule()));
  const MotionStatus motion;
  ASSERT_TRUE(sink->on_image({frame_with_events(), record_of(7), motion, nullptr, MonoTime{seconds(0.7)}}));
  ASSERT_TRUE(sink->finish());
  const auto trace = test::check_trace_file(scratch / "trace.json");
  EXPECT_THAT(trace.problems, testing::IsEmpty());
  EXPECT_EQ(trace.instants.at("task: search: the object is lost"), 1);
}

}  // namespace
}  // namespace cgsr::sinks
