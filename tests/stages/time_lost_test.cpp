#include "pipeline/stages/time_lost.h"

#include <gtest/gtest.h>

namespace cgsr::stages {
namespace {

using localization::Reason;
using localization::TrackState;

constexpr double kImage_s = 0.1;

class TimeLostOf : public ::testing::Test {
 protected:
  /// So many images of a lost pose, one every 0.1 s.
  void images(int count, Reason reason, TrackState state = TrackState::kLost) {
    localization::TrackedPose pose;
    pose.state = state;
    pose.correction.reason = reason;
    for (int i = 0; i < count; ++i) time_.add(pose, MonoTime{seconds(now_s_ += kImage_s)});
  }
  [[nodiscard]] double lasted_s() const { return to_seconds(time_.lasted()); }

  TimeLost time_;
  double now_s_ = 100.0;
};

TEST_F(TimeLostOf, ImagesThatRefuseThePoseIsTheirTime) {
  images(1, Reason::kNone, TrackState::kTracking);
  images(10, Reason::kUnexplained);
  EXPECT_NEAR(lasted_s(), 1.0, 1e-6);
  images(5, Reason::kAmbiguous);
  images(5, Reason::kTooFewMatches);
  EXPECT_NEAR(lasted_s(), 2.0, 1e-6);
  images(1, Reason::kNone, TrackState::kRecovered);
  EXPECT_EQ(lasted_s(), 0.0);
}

TEST_F(TimeLostOf, ImagesThatSayNothingIsNone) {
  images(1, Reason::kNone, TrackState::kTracking);
  for (const Reason reason : {Reason::kTooDark, Reason::kTooBright, Reason::kTooFewEdges, Reason::kNothingExpected,
                              Reason::kNoBudget, Reason::kWrongSize, Reason::kNoMap}) {
    images(10, reason);
    EXPECT_EQ(lasted_s(), 0.0) << to_string(reason);
  }
  images(10, Reason::kUnexplained);
  images(100, Reason::kTooDark);
  images(10, Reason::kUnexplained);
  EXPECT_NEAR(lasted_s(), 2.0, 1e-6) << "what counted before goes on to count";
}

TEST_F(TimeLostOf, ASearchCountsWithItsAnswer) {
  images(1, Reason::kNone, TrackState::kTracking);
  images(10, Reason::kSearching);
  EXPECT_EQ(lasted_s(), 0.0) << "it may yet find the pose";
  images(1, Reason::kUnexplained);
  EXPECT_NEAR(lasted_s(), 1.1, 1e-6);
  images(10, Reason::kSearching);
  images(1, Reason::kNothingExpected);
  images(1, Reason::kUnexplained);
  EXPECT_NEAR(lasted_s(), 1.2, 1e-6) << "of a search where the map shows nothing";
}

TEST_F(TimeLostOf, APoseThatIsNotLostIsNone) {
  images(100, Reason::kUnexplained, TrackState::kUnsure);
  images(100, Reason::kUnexplained, TrackState::kTracking);
  EXPECT_EQ(lasted_s(), 0.0);
}

TEST_F(TimeLostOf, AGapWithoutImagesIsNone) {
  images(1, Reason::kUnexplained);
  EXPECT_EQ(lasted_s(), 0.0) << "since when, the first one does not know";
  now_s_ += 3600.0;
  images(1, Reason::kUnexplained);
  EXPECT_LE(lasted_s(), 0.5);
  now_s_ -= 7200.0;
  images(1, Reason::kUnexplained);
  EXPECT_LE(lasted_s(), 0.5) << "time that runs back";
}

TEST_F(TimeLostOf, ALossThatIsGivenUpIsNoneUntilTheNextOne) {
  images(10, Reason::kUnexplained);
  time_.give_up();
  images(10, Reason::kUnexplained);
  EXPECT_EQ(lasted_s(), 0.0);
  images(1, Reason::kNone, TrackState::kRecovered);
  images(10, Reason::kUnexplained);
  EXPECT_NEAR(lasted_s(), 1.0, 1e-6);
}

}  // namespace
}  // namespace cgsr::stages
