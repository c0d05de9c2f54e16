// A shirt at its place: where its blob is no guide, what that teaches, and what vetoes it.

#include <algorithm>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "pipeline/person/tracking/person_tracker.h"
#include "tests/person/drawn_people.h"

namespace cgsr::person {
namespace {

// A face more, which says where the shirt is that was learned.
void show_face(PersonTracker& tracker, const Picture& picture) {
  tracker.update({picture.view()});
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  tracker.update({picture.view(), face_of(1)});
}

// A pipe of the shirt's colours touches it, and leads along the ceiling: one blob, wider than a shirt is.
Picture beside_a_pipe() {
  Picture picture = standing(kRed);
  picture.fill({270, 0, 20, 240}, kRed);
  picture.fill({0, 0, 320, 10}, kRed);
  picture.fill({200, 120, 70, 4}, kRed);
  return picture;
}

TEST(ShirtPlace, NamesThePersonWhereTheShirtAndSomethingElseAreOneBlob) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  show_face(tracker, standing(kRed));
  const Picture picture = beside_a_pipe();
  for (int image = 0; image < 10; ++image) {
    const auto sighting = tracker.update({picture.view()});
    ASSERT_EQ(sighting.person, 1) << image;
    EXPECT_EQ(sighting.source, PersonSource::kShirt);
    EXPECT_NEAR(sighting.box.x + sighting.box.width / 2, kShirtBox.x + kShirtBox.width / 2, 12.0);
    EXPECT_NEAR(sighting.face_px, kFaceBox.width, 4.0);
  }
}

// 6.3.1: where no shirt is as wide as a trunk, its place names nobody either.
TEST(ShirtPlace, VetoesAPlaceOfImplausibleSize) {
  PersonTrackerParameters parameters;
  parameters.shirt.max_width = 1.0;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  const Picture picture = standing(kRed);
  learn(tracker, 1, kRed);
  show_face(tracker, picture);
  pass_to_next_look(tracker, picture);
  for (int image = 0; image < 10; ++image) EXPECT_EQ(tracker.update({picture.view()}).person, std::nullopt) << image;
}

// A table hides most of the shirt: who stands behind it is no farther away.
TEST(ShirtPlace, SaysHowFarAwayACoveredShirtIs) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  show_face(tracker, standing(kRed));
  Picture picture = standing(kRed);
  picture.fill({0, 110, 320, 130}, kWall);
  for (int image = 0; image < 10; ++image) {
    const auto sighting = tracker.update({picture.view()});
    ASSERT_EQ(sighting.person, 1) << image;
    EXPECT_EQ(sighting.source, PersonSource::kShirt);
    EXPECT_NEAR(sighting.face_px, kFaceBox.width, 4.0);
  }
}

// Somebody turns round: from one side on what is seen is another print.
TEST(ShirtPlace, LearnsWhatComesIntoViewThere) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  Picture picture = standing(kRed);
  show_face(tracker, picture);
  for (int image = 1; image <= 80; ++image) {
    picture.fill({kShirtBox.x, kShirtBox.y, double(image), kShirtBox.height}, kBlue);
    tracker.update({picture.view()});
  }
  EXPECT_EQ(tracker.update({picture.view()}).person, 1) << "in blue by now";
}

// Seen from the side a trunk is narrower: the wall beside it, which was another when the shirt was learned, is no shirt, and nobody is there without the shirt.
TEST(ShirtPlace, DoesNotLearnTheWallBehindWhoeverTurnsSideways) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  show_face(tracker, standing(kRed));
  const Picture wall{kBlue};
  Picture picture = wall;
  picture.fill({kShirtBox.x + 0.17 * kShirtBox.width, kShirtBox.y, 0.66 * kShirtBox.width, kShirtBox.height}, kRed);
  for (int image = 0; image < 80; ++image) ASSERT_EQ(tracker.update({picture.view()}).person, 1) << image;
  for (int image = 0; image < 80; ++image) EXPECT_EQ(tracker.update({wall.view()}).person, std::nullopt) << image;
}

// 6.3.1, size and motion: the shirt is gone, and the foot of a door has its colours. A shirt as large as it was may have gone anywhere.
TEST(ShirtPlace, IsNotAScrapElsewhereAsSoonAsTheShirtIsGone) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  constexpr Box kScrap{20, 200, 40, 12}, kMoved{220, 80, 80, 100};
  for (const Box& elsewhere : {kScrap, kMoved}) {
    PersonTracker tracker(parameters);
    learn(tracker, 1, kRed);
    show_face(tracker, standing(kRed));
    ASSERT_EQ(tracker.update({standing(kRed).view()}).person, 1);
    Picture picture;
    picture.fill(elsewhere, kRed);
    const bool is_shirt = elsewhere.area() == kMoved.area();
    for (int image = 0; image < 60; ++image)
      EXPECT_EQ(tracker.update({picture.view()}).person == 1, is_shirt) << image << (is_shirt ? " moved" : " scrap");
  }
}

// Somebody who was out of sight comes back farther away. That he was nearer before makes no scrap of his shirt where it is covered for a moment.
TEST(ShirtPlace, IsOfAnotherSizeAfterALoss) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  learn(tracker, 1, kRed);
  const Picture near = standing(kRed), empty;
  tracker.update({near.view()});
  for (int image = 0; image < 100; ++image) tracker.update({empty.view()});
  Picture far, beside;
  far.fill({40, 100, 30, 36}, kRed);
  beside.fill({200, 100, 30, 36}, kRed);
  ASSERT_EQ(tracker.update({far.view()}).person, 1);
  for (int image = 0; image < 5; ++image) EXPECT_EQ(tracker.update({empty.view()}).person, std::nullopt);
  EXPECT_EQ(tracker.update({beside.view()}).person, 1);
}

// Somebody walks away from the lamp, is out of sight, and comes back where his shirt was learned.
TEST(ShirtPlace, IsFoundInTheLightOfLearningAfterALongLoss) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  learn(tracker, 1, kRed);
  const auto in_light = [](double gain) {
    Picture picture{{gain * kWall.r, gain * kWall.g, gain * kWall.b}};
    picture.fill(kShirtBox, {gain * kRed.r, gain * kRed.g, gain * kRed.b});
    return picture;
  };
  for (const double gain : {1.0, 0.75, 0.55})
    for (int image = 0; image < 10; ++image) tracker.update({in_light(gain).view()});
  ASSERT_EQ(tracker.update({in_light(0.55).view()}).person, 1);
  ASSERT_LT(tracker.shirts().light_of(1)->r, 0.6) << "that of where it was last";
  for (int image = 0; image < 60; ++image) ASSERT_EQ(tracker.update({Picture{}.view()}).person, std::nullopt) << image;
  std::optional<int> found_after;
  for (int image = 0; image < 30 && !found_after; ++image)
    if (tracker.update({standing(kRed).view()}).person == 1) found_after = image;
  ASSERT_TRUE(found_after);
  EXPECT_LE(*found_after, 4);
}

// A robot drives up to somebody who stands with the back to it: the trunk between the sleeves is its guide, which is not left small in a corner of the shirt.
TEST(ShirtPlace, GrowsWithAShirtThatComesNearer) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  constexpr double kFace_px = 24.0;
  const auto with_sleeves = [](double size) {
    Picture picture;
    const double middle = 160.0 - 20.0 * (size - 1.0), top = 95.0 - 20.0 * size;  // and he goes to the side
    picture.fill({middle - 27.0 * size, top, 54.0 * size, 80.0 * size}, kRed);
    picture.fill({middle - 42.0 * size, top, 84.0 * size, 40.0 * size}, kRed);
    return picture;
  };
  FaceSighting face = face_of(1);
  face.box = {160.0 - kFace_px / 2, 46.0, kFace_px, kFace_px};
  const Picture first = with_sleeves(1.0);
  for (int image = 0; image < 30; ++image) tracker.update({first.view(), face});
  double size = 1.0;
  PersonSighting sighting;
  for (int image = 0; image < 80; ++image) {
    size *= 1.008;
    sighting = tracker.update({with_sleeves(size).view()});
    ASSERT_EQ(sighting.person, 1) << image;
  }
  EXPECT_NEAR(sighting.face_px, size * kFace_px, 0.15 * size * kFace_px);
}

// Cloth in folds, from what faces the lamp to what turns away from it, in a light of one gain.
Picture in_folds(const Rgb& shirt, double gain) {
  constexpr double kFold = 16.0, kDarkest = 0.82;
  Picture picture{{gain * kWall.r, gain * kWall.g, gain * kWall.b}};
  for (double x = 0.0; x < kShirtBox.width; x += 2.0) {
    const double all = gain * (1.0 - (1.0 - kDarkest) * std::abs(std::remainder(x, kFold)) * 2.0 / kFold);
    picture.fill({kShirtBox.x + x, kShirtBox.y, 2.0, kShirtBox.height}, {all * shirt.r, all * shirt.g, all * shirt.b});
  }
  return picture;
}

// A lamp that is dimmed slowly, and one that is switched while the shutter is open: half as much light is .73 of a channel as the camera codes it.
TEST(ShirtPlace, IsFollowedWhereTheLightChangesByTwo) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  const Rgb shirts[] = {kRed, kBlue, {0.06, 0.44, 0.56}, {0.55, 0.42, 0.05}};
  for (const Rgb& shirt : shirts) {
    for (const bool slowly : {true, false}) {
      for (const double to : {0.73, 1.3}) {
        PersonTracker tracker(parameters);
        const Picture picture = in_folds(shirt, 1.0);
        for (int image = 0; image < 20 && !tracker.shirts().knows(1); ++image)
          tracker.update({picture.view(), face_of(1)});
        for (int image = 0; image < 20; ++image) tracker.update({picture.view()});
        int lost = 0;
        constexpr int kImages = 60;
        for (int image = 1; image <= 2 * kImages; ++image) {
          const double done = slowly ? std::min(1.0, double(image) / kImages) : image == 1 ? 0.4 : 1.0;
          lost += tracker.update({in_folds(shirt, 1.0 + done * (to - 1.0)).view()}).person == 1 ? 0 : 1;
        }
        EXPECT_LE(lost, kImages / 10) << shirt.r << ' ' << shirt.g << ' ' << shirt.b
                                      << (slowly ? " slowly to " : " at once to ") << to;
      }
    }
  }
}

// A jacket of the colour of the road behind it, and a red shirt below it.
TEST(ShirtPlace, HasNotTheColoursThatAreBesideTheTrunk) {
  PersonTrackerParameters parameters;
  parameters.shirt.place.enabled = false;
  PersonTracker tracker(parameters);
  Picture picture = standing(kBlue);
  picture.fill({150, 80, 20, 100}, kRed);
  picture.fill({0, 100, 115, 140}, kBlue);
  picture.fill({205, 100, 115, 140}, kBlue);
  for (int image = 0; image < 20; ++image) tracker.update({picture.view(), face_of(1)});
  ASSERT_TRUE(tracker.shirts().knows(1));
  for (int image = 0; image < 3; ++image) tracker.update({picture.view()});
  EXPECT_NEAR(tracker.shirts().box().width, 20.0, 4.0);
}

// A stranger beside the person leaves him his place; one who stands there takes it.
TEST(ShirtPlace, IsKeptWhereAStrangerPassesBesideIt) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  for (const bool there : {false, true}) {
    PersonTracker tracker(parameters);
    learn(tracker, 1, kRed);
    show_face(tracker, standing(kRed));
    const Picture picture = beside_a_pipe();
    FaceSighting stranger = face_of(std::nullopt);
    if (!there) stranger.box.x = 20.0;
    while (!tracker.face_is_due()) tracker.update({picture.view()});
    tracker.update({picture.view(), stranger});
    ASSERT_EQ(tracker.update({picture.view()}).person, there ? kStranger : Label{1});
    EXPECT_EQ(tracker.shirts().box().width > 1.5 * kShirtBox.width, there) << "the blob with the pipe, or the place";
  }
}

// A marker that is turned away says nothing about the place.
TEST(ShirtPlace, IsFollowedWhereAMarkerIsTurnedAway) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  learn(tracker, 1, kRed);
  show_face(tracker, standing(kRed));
  const Picture picture = beside_a_pipe();
  MarkerSighting turned;
  turned.box = {150, 90, 10, 20};
  turned.face = kFaceBox;
  turned.person = 1;
  tracker.update({.image = picture.view(), .marker = turned});
  EXPECT_NEAR(tracker.shirts().box().width, 2.2 * kFaceBox.width, 12.0);
}

// The labels of an image are those of the people who were known when its map was made.
TEST(ShirtPlace, IsTheSamePersonsWhenAnotherIsForgotten) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  learn(tracker, 1, kRed);
  learn(tracker, 2, kBlue);
  const Picture picture = standing(kBlue);
  for (int image = 0; image < 3 || !tracker.face_is_due(); ++image) tracker.update({picture.view()});
  tracker.forget(1);
  for (int image = 0; image < 4; ++image) EXPECT_EQ(tracker.update({picture.view()}).person, 2) << image;
}

}  // namespace
}  // namespace cgsr::person
