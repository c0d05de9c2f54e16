#include "pipeline/runtime/frame_record.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace cgsr::runtime {
namespace {

TEST(FrameRecord, KeepsTheFirstFault) {
  FrameRecord record;
  EXPECT_EQ(fault_of(record), "");
  note_fault(record, "track", "assertion failed");
  note_fault(record, "face", "out of memory");
  EXPECT_EQ(fault_of(record), "track: assertion failed");
}

TEST(FrameRecord, CutsWhatDoesNotFit) {
  FrameRecord record;
  note_fault(record, "track", std::string(500, 'x'));
  EXPECT_EQ(fault_of(record), "track: " + std::string(FrameRecord::kFaultBytes - 1 - 7, 'x'));
  record = {};
  note_fault(record, std::string(500, 's'), "what");
  EXPECT_EQ(fault_of(record), std::string(FrameRecord::kFaultBytes - 1, 's'));
}

TEST(FrameRecord, EveryOutcomeHasItsWord) {
  std::set<std::string_view> words;
  for (const auto outcome : {StageOutcome::kNotCalled, StageOutcome::kNotDue, StageOutcome::kSkipped,
                             StageOutcome::kRan, StageOutcome::kFaulted}) {
    words.insert(to_string(outcome));
  }
  EXPECT_EQ(words.size(), 5U);
  EXPECT_EQ(words.count("unknown"), 0U);
}

}  // namespace
}  // namespace cgsr::runtime
