// Who wears the person's shirt and is somebody else (6.4.3).

#include <optional>

#include <gtest/gtest.h>

#include "pipeline/person/tracking/person_tracker.h"
#include "tests/person/drawn_people.h"

namespace cgsr::person {
namespace {

// 6.4.3: a stranger in the same shirt is noticed by his face, which teaches the shirt nothing.
TEST(PersonTracker, CallsAStrangerInTheSameShirtAStranger) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  const auto stranger = tracker.update({picture.view(), face_of(std::nullopt)});
  EXPECT_EQ(stranger.person, kStranger);
  EXPECT_EQ(stranger.source, PersonSource::kFace);
  EXPECT_TRUE(tracker.shirts().knows(1));
}

/// Red is person 1's shirt, and a stranger's face was just decided on above it.
void meet_a_stranger_in_red(PersonTracker& tracker) {
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  ASSERT_EQ(tracker.update({picture.view(), face_of(std::nullopt)}).person, kStranger);
}

// A stranger who resembles somebody else who is enrolled: whether it is that one is open, that it is not the person whose shirt it is, is not.
TEST(PersonTracker, IsNotNamedByTheShirtWhereTheFaceIsSurelyNoneOfThePersons) {
  for (const Label nearest : {1, 2}) {
    PersonTracker tracker;
    learn(tracker, 1, kRed);
    const Picture picture = standing(kRed);
    while (!tracker.face_is_due()) tracker.update({picture.view()});
    FaceSighting face = face_of(std::nullopt, 0.6);
    face.match.nearest = nearest;
    face.match.rules_out = 0.85;
    const auto sighting = tracker.update({picture.view(), face, 1});
    EXPECT_EQ(sighting.person, nearest == 1 ? 1 : kStranger);
    if (nearest == 1) continue;
    while (!tracker.face_is_due()) tracker.update({picture.view()});
    face.match.label = 2;
    EXPECT_EQ(tracker.update({picture.view(), face, 1}).person, kStranger) << "an unsure name is none";
    while (!tracker.face_is_due()) tracker.update({picture.view()});
    face.match.confidence = 0.8;
    EXPECT_EQ(tracker.update({picture.view(), face, 1}).person, 2);
  }
}

// His face is lost for some images where the robot sways: his shirt does not name the person again meanwhile.
TEST(PersonTracker, AStrangerStaysOneForASecondWithoutHisFace) {
  PersonTracker tracker;
  meet_a_stranger_in_red(tracker);
  int stranger_images = 0;
  for (int image = 1; image <= 60; ++image) {
    Picture swaying(kWall);
    Box shirt = kShirtBox;
    shirt.y += 3 * (image % 5);
    swaying.fill(shirt, kRed);
    const auto sighting = tracker.update({swaying.view()});
    if (sighting.person != kStranger) break;
    EXPECT_EQ(sighting.source, PersonSource::kShirt);
    ++stranger_images;
  }
  EXPECT_NEAR(stranger_images, 30, 2);
  EXPECT_EQ(tracker.update({standing(kRed).view()}).person, 1) << "from behind the shirt alone counts";
}

TEST(PersonTracker, AStrangersFaceThatWasLostBesideTheShirtIsNotAboveIt) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  FaceSighting beside = face_of(std::nullopt);
  beside.box.x = kShirtBox.x + kShirtBox.width + 10;
  tracker.update({picture.view(), beside});
  for (int image = 0; image < 30; ++image) {
    Picture growing(kWall);
    Box shirt = kShirtBox;
    shirt.width += 2 * image;
    growing.fill(shirt, kRed);
    EXPECT_NE(tracker.update({growing.view()}).person, kStranger) << image;
  }
}

TEST(PersonTracker, AStrangerIsOneNoLongerWhereThePersonsFaceIsSeen) {
  PersonTracker tracker;
  const Picture picture = standing(kRed);
  meet_a_stranger_in_red(tracker);
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  EXPECT_EQ(tracker.update({picture.view(), face_of(1)}).person, 1);
  EXPECT_EQ(tracker.update({picture.view()}).person, 1);
}

TEST(PersonTracker, AStrangerBesideThePersonSaysNothingOfHisShirt) {
  PersonTracker tracker;
  meet_a_stranger_in_red(tracker);
  Picture elsewhere;
  elsewhere.fill({10, 80, 80, 100}, kRed);
  EXPECT_EQ(tracker.update({elsewhere.view()}).person, 1);
}

}  // namespace
}  // namespace cgsr::person
