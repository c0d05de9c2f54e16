// How far away a person is by the size of the shirt.

#include <gtest/gtest.h>

#include "pipeline/person/tracking/person_tracker.h"
#include "tests/person/drawn_people.h"

namespace cgsr::person {
namespace {

/// The shirt of person 1 is as long as kShirtBox, that of person 2 half as long; both were seen below faces of one size.
constexpr Box kShortShirt{120, 80, 80, 50};

Picture in_short_shirt() {
  Picture picture;
  picture.fill(kShortShirt, kBlue);
  return picture;
}

void measure_both(PersonTracker& tracker) {
  for (const Label person : {2, 1}) {
    const Picture picture = person == 1 ? standing(kRed) : in_short_shirt();
    for (int image = 0; image < 60; ++image) tracker.update({picture.view(), face_of(person)});
    ASSERT_TRUE(tracker.shirts().knows(person));
  }
}

PersonTrackerParameters by_blobs() {
  PersonTrackerParameters parameters;
  parameters.shirt.place.enabled = false;
  parameters.face_color.enabled = false;
  return parameters;
}

TEST(PersonTracker, TellsHowFarAwayAShirtIsByTheSizeOfItsOwnPerson) {
  PersonTracker tracker(by_blobs());
  measure_both(tracker);
  for (const Picture& picture : {in_short_shirt(), standing(kRed)}) {
    PersonSighting turned;
    for (int image = 0; image < 4; ++image) turned = tracker.update({picture.view()});
    ASSERT_EQ(turned.source, PersonSource::kShirt);
    EXPECT_NEAR(turned.face_px, kFaceBox.width, 2.0) << "of person " << *turned.person;
  }
}

// He comes back nearer, so that a border of the image cuts the shirt: 1.5 times as large, and less of its height is in view than from afar.
TEST(PersonTracker, TellsHowFarAwayAShirtIsThatTheImageCuts) {
  PersonTracker tracker(by_blobs());
  measure_both(tracker);
  for (const double top : {-90.0, 150.0}) {
    const Picture empty;
    for (int image = 0; image < 6; ++image) tracker.update({empty.view()});
    Picture picture;
    const Box near{100, top, 1.5 * kShirtBox.width, 1.5 * kShirtBox.height};
    picture.fill(intersection(near, {0, 0, kWidth, kHeight}), kRed);
    PersonSighting turned;
    for (int image = 0; image < 4; ++image) turned = tracker.update({picture.view()});
    ASSERT_EQ(turned.source, PersonSource::kShirt);
    EXPECT_NEAR(turned.face_px, 1.5 * kFaceBox.width, 3.0) << "its upper edge at " << top;
  }
}

TEST(PersonTracker, KeepsTheSizesOfThoseWhomItKnowsHoweverManyPass) {
  PersonTracker tracker(by_blobs());
  measure_both(tracker);
  const Picture empty;
  for (Label passer_by = 100; passer_by < 150; ++passer_by) {
    FaceSighting face = face_of(passer_by);
    face.box = {20, 20, 30, 30};
    for (int image = 0; image < 2; ++image) tracker.update({empty.view(), face});
  }
  const Picture red = standing(kRed);
  for (int image = 0; image < 4; ++image) tracker.update({red.view()});
  EXPECT_NEAR(tracker.update({red.view()}).face_px, kFaceBox.width, 2.0);
}

// 6.3.1: somebody else's face, far away, says nothing of how wide the person's shirt may be.
TEST(PersonTracker, JudgesTheSizeOfAShirtByTheFaceOfItsOwnPerson) {
  PersonTracker tracker(by_blobs());
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  FaceSighting far = face_of(2);
  far.box = {260, 40, 12, 12};
  for (int image = 0; image < 4; ++image) tracker.update({picture.view(), far});
  for (int image = 0; image < 4; ++image) tracker.update({picture.view()});
  EXPECT_EQ(tracker.update({picture.view()}).person, 1);
}

}  // namespace
}  // namespace cgsr::person
