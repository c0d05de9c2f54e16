#include <gtest/gtest.h>

#include "pipeline/stages/tasks.h"

namespace cgsr::stages {
namespace {

constexpr Duration kImage = seconds(1.0 / 30.0);

class FollowPerson : public testing::Test {
 protected:
  FollowPerson() {
    camera_.width_px = 640;
    camera_.height_px = 480;
    camera_.fx_px = camera_.fy_px = 600.0;
    camera_.cx_px = 320.0;
    camera_.cy_px = 240.0;
  }

  FollowPersonTask task(int number) {
    behavior::FollowPersonParameters person;
    person.number = number;
    person.face_width_m = 0.15;
    behavior::FollowParameters follow;
    follow.distance_m = 1.5;
    return {person, follow, behavior::DriveLimits{}, camera_};
  }

  /// A face of this width in the middle of the image, of 600 * 0.15 px at a metre.
  static person::PersonSighting face(std::optional<person::Label> person, double width_px) {
    person::PersonSighting sighting;
    sighting.person = person;
    sighting.source = person::PersonSource::kFace;
    sighting.confidence = 0.9;
    sighting.box = {320 - width_px / 2, 100, width_px, width_px};
    sighting.face_px = width_px;
    return sighting;
  }

  Decision see(FollowPersonTask& task, const person::PersonSighting& sighting) {
    FrameResult frame;
    frame.people.value.person = sighting;
    frame.people.age = Duration::zero();
    return task.decide(frame, image_, kImage);
  }

  geometry::Camera camera_;
  ImageView image_{nullptr, 640, 480, 1280, PixelFormat::kYuyv};
};

TEST_F(FollowPerson, DrivesTowardsThePersonWhoIsFarAndStandsAtTheDistance) {
  auto far = task(4);
  for (int i = 0; i < 30; ++i) see(far, face(4, 30.0));  // 3 m
  EXPECT_GT(see(far, face(4, 30.0)).goal.forward_mps, 0.1);
  auto near = task(4);
  for (int i = 0; i < 30; ++i) see(near, face(4, 60.0));  // 1.5 m
  EXPECT_DOUBLE_EQ(see(near, face(4, 60.0)).goal.forward_mps, 0.0);
}

TEST_F(FollowPerson, StandsBeforeAStrangerAndBeforeSomebodyElse) {
  for (const person::Label other : {person::kStranger, 5}) {
    auto follower = task(4);
    for (int i = 0; i < 30; ++i) see(follower, face(4, 30.0));
    const Decision decision = see(follower, face(other, 30.0));
    EXPECT_TRUE(decision.halt) << other;
    EXPECT_DOUBLE_EQ(decision.goal.forward_mps, 0.0) << other;
    EXPECT_EQ(decision.reason, other == person::kStranger ? "a stranger is in view" : "somebody else is in view");
  }
}

TEST_F(FollowPerson, SaysThatItIsNotSureWhereAFaceHasNoNameYet) {
  auto follower = task(4);
  FrameResult frame;
  frame.people.age = Duration::zero();
  frame.people.value.face_count = 1;
  EXPECT_EQ(IdentifiedPeople::state_of(frame.people.value), PersonState::kUnsure);
  const Decision decision = follower.decide(frame, image_, kImage);
  EXPECT_TRUE(decision.halt);
  EXPECT_EQ(decision.reason, "not sure who is in view");
  frame.people.value.face_count = 0;
  EXPECT_EQ(IdentifiedPeople::state_of(frame.people.value), PersonState::kNobody);
}

TEST_F(FollowPerson, GoesOnWhereAFewImagesShowNobodyAndStopsThen) {
  auto follower = task(4);
  for (int i = 0; i < 30; ++i) see(follower, face(4, 30.0));
  EXPECT_GT(see(follower, {}).goal.forward_mps, 0.0);
  Decision last;
  for (int i = 0; i < 15; ++i) last = see(follower, {});
  EXPECT_TRUE(last.halt);
}

TEST_F(FollowPerson, WithoutANumberFollowsTheFirstWhoIsEnrolledAndNobodyElse) {
  auto follower = task(0);
  EXPECT_EQ(follower.first_requests().person, std::nullopt);
  EXPECT_TRUE(see(follower, face(person::kStranger, 30.0)).halt);
  EXPECT_FALSE(see(follower, face(7, 30.0)).halt);
  EXPECT_EQ(see(follower, face(7, 30.0)).requests.person, 7);
  EXPECT_TRUE(see(follower, face(8, 30.0)).halt);
}

TEST_F(FollowPerson, DoesNotDriveByAnIdentificationThatIsNotOfThisImage) {
  auto follower = task(4);
  FrameResult frame;
  frame.people.value.person = face(4, 30.0);
  frame.people.stamp = MonoTime{seconds(1.0)};
  frame.people.age = kImage;
  EXPECT_TRUE(follower.decide(frame, image_, kImage).halt);
}

}  // namespace
}  // namespace cgsr::stages
