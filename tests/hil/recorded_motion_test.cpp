// The recorded motion of the base: what was said last is said again, and a file that is none is refused with its line.
#include "tests/hil/recorded_motion.h"

#include <cstdint>
#include <fstream>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace cgsr::hil::testing {
namespace {

constexpr const char* kTwoMessages =
    "401 10000000 0102030405060708\n"
    "404 10000000 ffffffffffffffff\n"
    "401 20000000 1112131415161718\n"
    "401 20000000 2122232425262728\n"
    "404 30000000 fefefefefefefefe\n";

class RecordedMotionOf : public ::testing::Test {
 protected:
  Result<RecordedMotion> load(const std::string& text) {
    std::ofstream(folder_ / "motion.txt") << text;
    return RecordedMotion::load((folder_ / "motion.txt").string());
  }

  /// What the base says in place of `own`, as the first and the last byte.
  static std::pair<int, int> said(RecordedMotion& motion, std::uint16_t id, double at_s) {
    hal::CanFrame frame{.id = id, .size = 8, .data = {0xA0, 0, 0, 0, 0, 0, 0, 0xA7}};
    motion.replace(frame, seconds(at_s));
    EXPECT_EQ(frame.id, id);
    EXPECT_EQ(frame.size, 8);
    return {frame.data.front(), frame.data.back()};
  }

  cgsr::test::ScratchFolder folder_;
};

using Bytes = std::pair<int, int>;

TEST_F(RecordedMotionOf, SaysOfEachMessageWhatWasSaidLast) {
  auto motion = load(kTwoMessages);
  ASSERT_TRUE(motion);
  EXPECT_EQ(said(*motion, 0x401, 0.010), (Bytes{0x01, 0x08}));
  EXPECT_EQ(said(*motion, 0x404, 0.010), (Bytes{0xFF, 0xFF}));
  EXPECT_EQ(said(*motion, 0x401, 0.019999), (Bytes{0x01, 0x08})) << "not before its time";
  EXPECT_EQ(said(*motion, 0x401, 0.020), (Bytes{0x21, 0x28})) << "the later one of two at the same time";
  EXPECT_EQ(said(*motion, 0x404, 0.025), (Bytes{0xFF, 0xFF})) << "each message by itself";
  EXPECT_EQ(said(*motion, 0x404, 0.030), (Bytes{0xFE, 0xFE}));
}

TEST_F(RecordedMotionOf, SaysTheFirstBeforeItsTimeAndTheLastForEver) {
  auto motion = load(kTwoMessages);
  ASSERT_TRUE(motion);
  EXPECT_EQ(said(*motion, 0x401, 0.0), (Bytes{0x01, 0x08}));
  EXPECT_EQ(said(*motion, 0x401, 3600.0), (Bytes{0x21, 0x28}));
  EXPECT_EQ(said(*motion, 0x404, 3600.0), (Bytes{0xFE, 0xFE}));
}

TEST_F(RecordedMotionOf, LeavesOtherMessagesAsTheyAre) {
  auto motion = load(kTwoMessages);
  ASSERT_TRUE(motion);
  for (const std::uint16_t id : {0x400, 0x402, 0x403, 0x405, 0x413, 0x412}) {
    EXPECT_EQ(said(*motion, id, 1.0), (Bytes{0xA0, 0xA7}));
  }
}

TEST_F(RecordedMotionOf, RefusesALineThatIsNoneWithItsNumber) {
  for (const std::string wrong :
       {"", "401", "401 20000000", "401 20000000 11121314151617", "401 20000000 111213141516171819",
        "401 20000000 1112131415161718 1", "401 20000000 11121314151617zz", "401 20000000 -112131415161718",
        "401 -1 1112131415161718", "800 20000000 1112131415161718", "-1 20000000 1112131415161718",
        "time 20000000 1112131415161718", "401 20000000000000000000 1112131415161718"}) {
    const auto motion = load("401 10000000 0102030405060708\n" + wrong + "\n");
    ASSERT_FALSE(motion) << wrong;
    EXPECT_NE(motion.error().message.find("motion.txt:2: '" + wrong + "'"), std::string::npos)
        << motion.error().message;
  }
}

TEST_F(RecordedMotionOf, RefusesTimeThatRunsBackAndAFileWithoutMessages) {
  const auto back = load("401 10000000 0102030405060708\n402 9999999 0102030405060708\n");
  ASSERT_FALSE(back);
  EXPECT_NE(back.error().message.find("motion.txt:2: 9999999 ns"), std::string::npos) << back.error().message;
  const auto empty = load("");
  ASSERT_FALSE(empty);
  EXPECT_NE(empty.error().message.find("motion.txt: holds no message"), std::string::npos) << empty.error().message;
  const auto missing = RecordedMotion::load((folder_ / "none.txt").string());
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("none.txt: No such file"), std::string::npos) << missing.error().message;
}

}  // namespace
}  // namespace cgsr::hil::testing
