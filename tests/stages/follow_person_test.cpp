#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/stages/tasks.h"
#include "tests/behavior/two_rooms.h"

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

  /// Person 4 by the shirt, above which a face is expected, and a stranger's face there or elsewhere.
  static FrameResult shirt_with_a_strangers_face(const Box& where) {
    FrameResult frame;
    frame.people.age = Duration::zero();
    IdentifiedPeople& people = frame.people.value;
    people.person = face(4, 30.0);
    people.person.source = person::PersonSource::kShirt;
    people.person.box = {270, 200, 100, 150};
    people.expected_face = Box{305, 150, 30, 30};
    people.faces[0] = {.number = 1, .box = where, .compared = true, .person = std::nullopt, .confidence = 0.6};
    people.face_count = 1;
    return frame;
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

// Not sure of the face, the feedback takes the shirt's word; for how long, is the task's to say.
TEST_F(FollowPerson, StopsFollowingAShirtBelowAFaceThatStaysAStrangers) {
  auto follower = task(4);
  for (int i = 0; i < 30; ++i) see(follower, face(4, 30.0));
  FrameResult frame = shirt_with_a_strangers_face({306, 152, 30, 30});
  Decision decision;
  for (int i = 0; i < 5; ++i) decision = follower.decide(frame, image_, kImage);
  EXPECT_FALSE(decision.halt) << "a few images may be wrong";
  for (int i = 0; i < 30; ++i) decision = follower.decide(frame, image_, kImage);
  EXPECT_TRUE(decision.halt);
  EXPECT_TRUE(follower.is_with_a_stranger());
  EXPECT_EQ(decision.reason, "the face above the shirt is a stranger's");
  frame.people.value.faces[0].person = 4;  // it is the person after all
  decision = follower.decide(frame, image_, kImage);
  EXPECT_FALSE(decision.halt);
}

TEST_F(FollowPerson, AStrangersFaceBesideTheShirtSaysNothingOfThePerson) {
  auto follower = task(4);
  for (int i = 0; i < 30; ++i) see(follower, face(4, 30.0));
  const FrameResult frame = shirt_with_a_strangers_face({420, 152, 30, 30});
  Decision decision;
  for (int i = 0; i < 60; ++i) decision = follower.decide(frame, image_, kImage);
  EXPECT_FALSE(decision.halt);
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

// After a loss a shirt alone is not believed; between two images in which the face is looked for it says nothing against the person either.
TEST_F(FollowPerson, GoesOnBetweenTwoFacesWhereAShirtIsNotBelieved) {
  auto follower = task(4);
  follower.follow_by_primary_only(true);
  const FrameResult shirt_alone = [] {
    FrameResult frame = shirt_with_a_strangers_face({306, 152, 30, 30});
    frame.people.value.face_count = 0;
    return frame;
  }();
  EXPECT_TRUE(follower.decide(shirt_alone, image_, kImage).halt) << "by a shirt nobody is found again";
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(see(follower, face(4, 30.0)).halt);
    EXPECT_FALSE(follower.decide(shirt_alone, image_, kImage).halt) << i;
  }
  Decision last;
  for (int i = 0; i < 30; ++i) last = follower.decide(shirt_alone, image_, kImage);
  EXPECT_TRUE(last.halt) << "nor followed for longer than a moment";
}

// What the last look for a face said is not seen anew: it ages as if nothing were said.
TEST_F(FollowPerson, StopsWhereTheFaceIsNotSeenAnew) {
  auto follower = task(4);
  for (int i = 0; i < 30; ++i) see(follower, face(4, 30.0));
  Decision last;
  for (int i = 0; i < 15; ++i) {
    person::PersonSighting old = face(4, 30.0);
    old.age_images = i + 1;
    last = see(follower, old);
  }
  EXPECT_TRUE(last.halt);
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

// Somebody who is known by shirt, the place above it dark and without a face: the line is asked for, and an event says why.
TEST_F(FollowPerson, AsksForTheFillLightWhereTheFaceIsInTheDark) {
  behavior::FillLightParameters light;
  light.enabled = true;
  std::vector<std::uint8_t> dark(std::size_t{2} * 640 * 480);
  for (std::size_t i = 0; i < dark.size(); ++i) dark[i] = i % 2 == 0 ? 18 : 128;
  const auto bright = std::vector<std::uint8_t>(dark.size(), 128);
  FrameResult frame;
  frame.people.age = Duration::zero();
  frame.people.value.person = face(4, 60.0);
  frame.people.value.person.source = person::PersonSource::kShirt;
  frame.people.value.expected_face = Box{290, 100, 60, 60};
  const auto asks = [&](FollowPersonTask& task, const std::vector<std::uint8_t>& pixels, int images) {
    Decision last;
    std::size_t events = 0;
    for (int i = 0; i < images; ++i) {
      last = task.decide(frame, {pixels.data(), 640, 480, 1280, PixelFormat::kYuyv}, kImage);
      for (const Event& event : last.events) events += event.source == "fill light" ? 1 : 0;
    }
    const bool on = last.requests.lamps[static_cast<std::size_t>(LampLine::kFillLight)];
    EXPECT_EQ(events, on ? 1U : 0U);
    return on;
  };
  FollowPersonTask lit({.number = 4}, {}, {}, camera_, light), unlit({.number = 4}, {}, {}, camera_);
  EXPECT_FALSE(asks(unlit, dark, 60)) << "not enabled";
  EXPECT_FALSE(asks(lit, bright, 60));
  EXPECT_TRUE(asks(lit, dark, 40));
  FollowPersonTask seen({.number = 4}, {}, {}, camera_, light);
  frame.people.value.face_count = 1;
  frame.people.value.faces[0].box = Box{295, 102, 55, 55};
  EXPECT_FALSE(asks(seen, dark, 60)) << "a face is there, whosever it is";
  FollowPersonTask outside({.number = 4}, {}, {}, camera_, light);
  frame.people.value.face_count = 0;
  frame.people.value.expected_face = Box{290, -50, 60, 60};
  EXPECT_FALSE(asks(outside, dark, 60)) << "most of its place is above the image";
  FollowPersonTask turned({.number = 4}, {}, {}, camera_, light);
  frame.people.value.person.source = person::PersonSource::kFace;
  frame.people.value.expected_face.reset();
  EXPECT_FALSE(asks(turned, dark, 150));
  frame.people.value.person.source = person::PersonSource::kShirt;
  frame.people.value.expected_face = Box{290, 100, 60, 60};
  EXPECT_FALSE(asks(turned, dark, 60)) << "the face was seen in that dark";
}

// Of a face that is found in the noise of the dark it stays open whose it is: that one needs the light.
TEST_F(FollowPerson, AsksForTheFillLightWhereAFaceInTheDarkStaysUnnamed) {
  behavior::FillLightParameters light;
  light.enabled = true;
  std::vector<std::uint8_t> dark(std::size_t{2} * 640 * 480);
  for (std::size_t i = 0; i < dark.size(); ++i) dark[i] = i % 2 == 0 ? 18 : 128;
  const auto asks = [&](bool compared) {
    FollowPersonTask task({.number = 4}, {}, {}, camera_, light);
    FrameResult frame;
    frame.people.age = Duration::zero();
    frame.people.value.face_count = 1;
    frame.people.value.faces[0] = {
        .number = 1, .box = {290, 100, 60, 60}, .compared = compared, .person = std::nullopt, .confidence = 0.6};
    Decision last;
    for (int i = 0; i < 60; ++i) last = task.decide(frame, {dark.data(), 640, 480, 1280, PixelFormat::kYuyv}, kImage);
    return last.requests.lamps[static_cast<std::size_t>(LampLine::kFillLight)];
  };
  EXPECT_TRUE(asks(false));
  EXPECT_FALSE(asks(true)) << "a stranger";
}

TEST_F(FollowPerson, DoesNotDriveByAnIdentificationThatIsNotOfThisImage) {
  auto follower = task(4);
  FrameResult frame;
  frame.people.value.person = face(4, 30.0);
  frame.people.stamp = MonoTime{seconds(1.0)};
  frame.people.age = kImage;
  EXPECT_TRUE(follower.decide(frame, image_, kImage).halt);
}

// The person is beyond a table that the map holds and the camera does not tell from the floor.
TEST_F(FollowPerson, StaysOnTheMapsFreeFloor) {
  FollowPersonTask task = this->task(4);
  task.keep_to(std::make_shared<behavior::FreeFloor>(behavior::test::two_rooms(), behavior::FreeFloorParameters{}));
  const auto goal_at = [&](double x_m, Duration pose_age) {
    FrameResult frame;
    frame.people.value.person = face(4, 30.0);
    frame.people.age = Duration::zero();
    frame.pose.value.robot = {true, x_m, 1.0, 0.0};  // looks along x, at the wall at 4 m
    frame.pose.age = pose_age;
    Decision decision;
    for (int image = 0; image < 60; ++image)
      decision = task.decide(frame, ImageView{nullptr, 640, 480, 1280, PixelFormat::kYuyv}, kImage);
    return decision;
  };
  EXPECT_GT(goal_at(1.0, Duration::zero()).goal.forward_mps, 0.2);
  const Decision before_the_wall = goal_at(3.58, Duration::zero());
  EXPECT_LT(before_the_wall.goal.forward_mps, 0.05);
  EXPECT_EQ(before_the_wall.reason, "the map's free floor ends there");
  EXPECT_GT(goal_at(3.58, seconds(60.0)).goal.forward_mps, 0.2) << "the pose is too old to say";
}

}  // namespace
}  // namespace cgsr::stages
