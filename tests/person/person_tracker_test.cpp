// What is tested is who teaches whom.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/person/tracking/person_tracker.h"
#include "tests/person/drawn_people.h"

namespace cgsr::person {
namespace {

// The story of Fig. 6.8: seen from the front, turned away, out of sight, back again.
TEST(PersonTracker, FollowsTheShirtWhereTheFaceIsTurnedAwayAndNobodyWhereHeIsGone) {
  PersonTracker tracker;
  learn(tracker, 4, kRed);
  const Picture picture = standing(kRed);
  for (int image = 0; image < 20; ++image) {
    const auto turned = tracker.update({picture.view()});
    EXPECT_EQ(turned.person, 4);
    EXPECT_EQ(turned.source, PersonSource::kShirt);
    EXPECT_EQ(turned.box, kShirtBox);
  }
  const Picture empty;
  for (int image = 0; image < 20; ++image) EXPECT_EQ(tracker.update({empty.view()}).person, std::nullopt);
  while (!tracker.face_is_due()) tracker.update({empty.view()});
  const auto back = tracker.update({picture.view(), face_of(4)});
  EXPECT_EQ(back.person, 4);
  EXPECT_EQ(back.source, PersonSource::kFace);
  EXPECT_EQ(back.box, kFaceBox);
}

TEST(PersonTracker, IsBlindWithoutAFaceBeforeAShirtIsLearned) {
  PersonTracker tracker;
  const Picture picture = standing(kRed);
  for (int image = 0; image < 9; ++image) {
    EXPECT_TRUE(tracker.face_is_due());
    tracker.update({picture.view(), face_of(4)});
  }
  EXPECT_EQ(tracker.update({picture.view()}).person, std::nullopt);
  EXPECT_FALSE(tracker.shirts().knows(4));
}

// 6.2.3: the face runs in every other image once there is a shirt.
TEST(PersonTracker, LooksForFacesInEveryOtherImageOnceAShirtIsKnown) {
  PersonTracker tracker;
  learn(tracker, 4, kRed);
  const Picture picture = standing(kRed);
  int due = 0;
  for (int image = 0; image < 20; ++image) {
    due += tracker.face_is_due() ? 1 : 0;
    tracker.update({picture.view()});
  }
  EXPECT_EQ(due, 10);
}

// From the sure confidence on a face has its own name beside the person's; below it, it is not the person's.
TEST(FaceClassifier, NamesSomebodyElseFromTheSureConfidenceOn) {
  PersonImage image;
  image.interest = 4;
  image.face = face_of(5, 0.85);
  image.face->match.nearest = 5;
  image.face->match.rules_out = 0.9;
  EXPECT_EQ(FaceClassifier(0.75).classify(image)->label, 5);
  EXPECT_EQ(FaceClassifier(0.95).classify(image)->label, kStranger);
}

// Where a shirt is not found between two looks for a face, what the last look said holds; what it did not see it does not say.
TEST(PersonTracker, BetweenTwoLooksForAFaceIsWhoTheLastOneNamed) {
  PersonTracker tracker;
  learn(tracker, 4, kRed);
  const Picture empty;
  for (const std::optional<Label> seen : {std::optional(4), std::optional(kStranger)}) {
    while (!tracker.face_is_due()) tracker.update({empty.view()});
    ASSERT_EQ(tracker.update({empty.view(), face_of(seen == kStranger ? std::nullopt : seen)}).person, seen);
    const auto between = tracker.update({empty.view()});
    EXPECT_EQ(between.person, seen);
    EXPECT_EQ(between.source, PersonSource::kFace);
    EXPECT_EQ(between.box, kFaceBox);
    EXPECT_EQ(between.face_px, kFaceBox.width);
    EXPECT_EQ(between.age_images, 1) << "it was not looked for in this image";
    for (int image = 0; image < 4; ++image) EXPECT_EQ(tracker.update({empty.view()}).person, std::nullopt) << image;
  }
}

// 6.2.4: two people exchange their shirts; by shirt alone they are mistaken, once a face is seen no longer.
TEST(PersonTracker, RelearnsTheShirtBelowAFaceThatContradictsIt) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  learn(tracker, 2, kBlue);
  const Picture blue = standing(kBlue);
  EXPECT_EQ(tracker.update({blue.view()}).person, 2) << "person 1 in the shirt of person 2, from behind";
  while (!tracker.face_is_due()) tracker.update({blue.view()});
  EXPECT_EQ(tracker.update({blue.view(), face_of(1)}).person, 1);
  const auto behind = tracker.update({blue.view()});
  EXPECT_EQ(behind.person, 1);
  EXPECT_EQ(behind.source, PersonSource::kShirt);
}

// 6.2.4: the light changed so much that the shirt is not found; a face brings it back.
TEST(PersonTracker, RelearnsAShirtThatIsNotFoundBelowItsFace) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture dim = standing({kRed.r / 2, kRed.g / 2, kRed.b / 2});
  EXPECT_EQ(tracker.update({dim.view()}).person, std::nullopt);
  while (!tracker.face_is_due()) tracker.update({dim.view()});
  tracker.update({dim.view(), face_of(1)});
  for (int image = 0; image < 2; ++image) tracker.update({dim.view()});  // the map of heads may come first
  const auto behind = tracker.update({dim.view()});
  EXPECT_EQ(behind.person, 1);
  EXPECT_EQ(behind.source, PersonSource::kShirt);
}

// Low in the image the place of the shirt is outside of it, or its upper edge alone is inside.
TEST(PersonTracker, KeepsTheLightOfAShirtThatIsOutOfViewBelowItsFace) {
  for (const double top : {200.0, 175.0}) {
    PersonTracker tracker;
    learn(tracker, 1, kRed);
    constexpr double kDimmer = 0.75;  // at once, everywhere
    const Rgb shirt{kDimmer * kRed.r, kDimmer * kRed.g, kDimmer * kRed.b};
    const Rgb wall{kDimmer * kWall.r, kDimmer * kWall.g, kDimmer * kWall.b};
    Picture dim(wall);
    dim.fill(kShirtBox, shirt);
    for (int image = 0; image < 10; ++image) tracker.update({standing(kRed).view()});
    for (int image = 0; image < 10; ++image) tracker.update({dim.view()});
    ASSERT_EQ(tracker.update({dim.view()}).person, 1);
    const auto light = tracker.shirts().light_of(1);
    ASSERT_TRUE(light);
    ASSERT_LT(light->r, 0.7) << "not as at learning";
    Picture low(wall);
    low.fill({140, 235, 40, 5}, shirt);
    FaceSighting face = face_of(1);
    face.box.y = top;
    while (!tracker.face_is_due()) tracker.update({low.view()});
    tracker.update({low.view(), face});
    ASSERT_TRUE(tracker.shirts().light_of(1));
    EXPECT_NEAR(tracker.shirts().light_of(1)->r, light->r, 1e-9) << "a face at " << top;
    for (int image = 0; image < 6; ++image) tracker.update({dim.view()});
    EXPECT_EQ(tracker.update({dim.view()}).person, 1) << "a face at " << top;
  }
}

// Nor is a shirt learned from the strip of it that is in view.
TEST(PersonTracker, LearnsNoShirtThatIsOutOfViewBelowItsFace) {
  PersonTracker tracker;
  Picture picture;
  picture.fill({140, 235, 40, 5}, kRed);
  FaceSighting face = face_of(1);
  face.box.y = 175.0;
  for (int image = 0; image < 30; ++image) tracker.update({picture.view(), face});
  EXPECT_FALSE(tracker.shirts().knows(1));
}

// The trunk that is followed can lie in a part of the shirt: a face above all of it is above it.
TEST(IsAbove, OfAFaceOverTheTrunk) {
  constexpr Box kFace{300, 150, 60, 60};
  EXPECT_TRUE(is_above(kFace, {270, 230, 120, 190}));
  EXPECT_TRUE(is_above(kFace, {290, 290, 90, 130})) << "its lower part";
  EXPECT_FALSE(is_above(kFace, {270, 420, 120, 60})) << "below the trunk";
  EXPECT_FALSE(is_above(kFace, {400, 230, 120, 190})) << "beside it";
  EXPECT_FALSE(is_above(kFace, {270, 100, 120, 190})) << "before it";
}

// Two primaries that disagree: the surer one decides, the marker where they are equal.
TEST(PersonTracker, BelievesTheSurerOfMarkerAndFace) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  const auto look = [&](double marker_confidence, const FaceSighting& face) {
    while (!tracker.face_is_due()) tracker.update({picture.view()});
    return tracker.update(
        {picture.view(), face, std::nullopt, MarkerSighting{{150, 110, 20, 20}, kFaceBox, 1, marker_confidence}});
  };
  const auto by_marker = look(0.98, face_of(2, 0.9));
  EXPECT_EQ(by_marker.person, 1);
  EXPECT_EQ(by_marker.source, PersonSource::kMarker);
  EXPECT_EQ(by_marker.box, (Box{150, 110, 20, 20}));
  EXPECT_EQ(by_marker.face_px, kFaceBox.width);
  EXPECT_EQ(look(0.8, face_of(2, 0.9)).person, 2);
  EXPECT_EQ(look(0.9, face_of(1, 0.9)).source, PersonSource::kMarker);
}

// Of a marker that is seen from aside the shirt is not where its box says, nor as wide.
TEST(PersonTracker, LearnsAShirtUnderAMarkerThatFacesTheCameraAlone) {
  const Picture picture = standing(kRed);
  for (const double width : {8.0, 20.0}) {
    PersonTracker tracker;
    const MarkerSighting marker{{150, 110, width, 20}, kFaceBox, 1, 0.95};
    for (int image = 0; image < 20; ++image)
      EXPECT_EQ(tracker.update({picture.view(), std::nullopt, std::nullopt, marker}).person, 1);
    EXPECT_EQ(tracker.shirts().knows(1), width == 20.0);
  }
}

// Two known people side by side: the shirt of the person of interest counts, not the larger one.
TEST(PersonTracker, KeepsToTheShirtOfThePersonOfInterestBesideALargerOne) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  learn(tracker, 2, kBlue);
  constexpr Box kSmaller{20, 90, 60, 70}, kLarger{200, 80, 80, 100};
  Picture both;
  both.fill(kSmaller, kRed);
  both.fill(kLarger, kBlue);
  PersonImage image{both.view()};
  EXPECT_EQ(tracker.update(image).person, 2) << "nobody is of interest";
  image.interest = 1;
  for (int i = 0; i < 6; ++i) {
    const auto sighting = tracker.update(image);
    EXPECT_EQ(sighting.person, 1);
    EXPECT_EQ(sighting.box, kSmaller);
  }
  const Picture blue = standing(kBlue);
  EXPECT_EQ(tracker.update({blue.view(), std::nullopt, 1}).person, 2) << "who is of interest is not there";
}

/// The shirt alone, once the face that was seen last says nothing any longer. \return whose it is.
std::optional<Label> turned_away(PersonTracker& tracker, const Picture& picture, std::optional<Label> interest) {
  for (int image = 0; image < 4; ++image) tracker.update({picture.view(), std::nullopt, interest});
  return tracker.update({picture.view(), std::nullopt, interest}).person;
}

// 6.2.2: equal shirts go to the latest person of interest, whoever was learned last.
TEST(PersonTracker, GivesEqualShirtsToTheLatestPersonOfInterest) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  learn(tracker, 2, kRed);
  ASSERT_TRUE(tracker.shirts().knows(2));
  const Picture red = standing(kRed);
  EXPECT_EQ(turned_away(tracker, red, 1), 1);
  EXPECT_EQ(turned_away(tracker, red, std::nullopt), 1) << "still the latest";
  EXPECT_EQ(turned_away(tracker, red, 2), 2);
}

TEST(PersonTracker, LeavesThePersonOfInterestTheColoursThatAnotherOneIsLearnedIn) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture red = standing(kRed), blue = standing(kBlue);
  ASSERT_EQ(turned_away(tracker, red, 1), 1);
  for (int image = 0; image < 30; ++image) tracker.update({red.view(), face_of(2), 1});
  ASSERT_TRUE(tracker.shirts().knows(2));
  EXPECT_EQ(turned_away(tracker, red, 1), 1) << "2 was learned";
  for (int image = 0; image < 30; ++image) tracker.update({blue.view(), face_of(2), 1});
  for (int image = 0; image < 30; ++image) tracker.update({red.view(), face_of(2), 1});
  EXPECT_EQ(turned_away(tracker, red, 1), 1) << "2 was relearned";
}

// Faces are looked for in every other image: in between his shirt is not taken for that of the person of interest.
TEST(PersonTracker, WhoIsDressedAsThePersonOfInterestIsNamedByTheFaceThatWasSeenLast) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  learn(tracker, 2, kRed);
  const Picture red = standing(kRed);
  ASSERT_EQ(turned_away(tracker, red, 1), 1);
  for (int image = 0; image < 20; ++image) {
    const bool due = tracker.face_is_due();
    const auto face = due ? std::optional(face_of(2)) : std::nullopt;
    const auto sighting = tracker.update({red.view(), face, 1});
    if (image > 1) {
      EXPECT_EQ(sighting.person, 2) << image;
    }
  }
}

// A map costs millions of instructions: equal shirts do not have one made for every face.
TEST(ShirtClassifier, RelearnsAShirtThatTwoPeopleWearNowAndThenOnly) {
  ColorLabels labels(kWidth, kHeight);
  ShirtClassifier shirts(labels, {});
  const Picture red = standing(kRed);
  const auto look = [&](Label face) {
    const PersonImage image{red.view(), face_of(face), 1};
    labels.look(image.image);
    shirts.classify(image);
    shirts.observe(image);
  };
  for (const Label person : {1, 2}) {
    for (int image = 0; image < 12; ++image) look(person);
    ASSERT_TRUE(shirts.knows(person));
  }
  shirts.prepare();
  int maps = 0;
  for (int image = 0; image < 60; ++image) {
    look(2);
    shirts.train(2, 1);
    maps += shirts.prepare() ? 1 : 0;
  }
  EXPECT_GE(maps, 3);
  EXPECT_LE(maps, 6);
}

// 6.3.1: a shirt as large as the wall is none.
TEST(PersonTracker, VetoesAShirtOfImplausibleSize) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture wall(kRed);
  EXPECT_EQ(tracker.update({wall.view()}).person, std::nullopt);
  Picture speck;
  speck.fill({100, 100, 6, 6}, kRed);
  EXPECT_EQ(tracker.update({speck.view()}).person, std::nullopt);
}

// 8.3: where it is dark a colour counts less, and a face that is less sure than a shirt in the light still decides.
TEST(PersonTracker, TrustsAShirtLessInTheDark) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  EXPECT_EQ(tracker.update({picture.view(), face_of(std::nullopt, 0.6)}).person, 1);
  while (!tracker.face_is_due()) tracker.update({picture.view()});
  PersonContexts dark;
  dark.shirt.dark = 1.0;
  EXPECT_EQ(tracker.update({picture.view(), face_of(std::nullopt, 0.6)}, dark).person, kStranger);
}

// A black shirt takes nothing from a face in the light, and a dark face nothing from a shirt.
TEST(PersonTracker, TrustsAFaceAboveADarkShirtAsMuch) {
  PersonTracker tracker;
  const Picture picture = standing(kRed);
  PersonContexts contexts;
  contexts.shirt.dark = 1.0;
  EXPECT_EQ(tracker.update({picture.view(), face_of(1, 0.9)}, contexts).confidence, 0.9);
  contexts.head.dark = 1.0;
  EXPECT_LT(tracker.update({picture.view(), face_of(1, 0.9)}, contexts).confidence, 0.6);
}

// The face alone, as Figure 6.8 compares it.
TEST(PersonTracker, KnowsNobodyByAShirtWhereShirtsAreTurnedOff) {
  PersonTrackerParameters parameters;
  parameters.shirt.enabled = parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  learn(tracker, 1, kRed);
  EXPECT_EQ(tracker.shirts().people(), 0U);
  while (!tracker.face_is_due()) tracker.update({standing(kRed).view()});
  ASSERT_EQ(tracker.update({standing(kRed).view(), face_of(1)}).person, 1);
  EXPECT_FALSE(tracker.face_is_due()) << "in every other image, as with a shirt";
  EXPECT_EQ(tracker.update({standing(kRed).view()}).source, PersonSource::kFace) << "until the next look";
  EXPECT_EQ(tracker.update({standing(kRed).view()}).person, std::nullopt);
}

// Dressed alike: the next image, in which no face is looked for, does not name whom nobody knows any more.
TEST(PersonTracker, ForgetsWhoseFaceWasSeenLast) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  learn(tracker, 2, kRed);
  const Picture red = standing(kRed);
  ASSERT_EQ(turned_away(tracker, red, 1), 1);
  while (!tracker.face_is_due()) tracker.update({red.view(), std::nullopt, 1});
  ASSERT_EQ(tracker.update({red.view(), face_of(2), 1}).person, 2);
  ASSERT_FALSE(tracker.face_is_due());
  tracker.forget(2);
  EXPECT_EQ(tracker.update({red.view(), std::nullopt, 1}).person, 1);
}

TEST(PersonTracker, ForgetsAPersonAndSurvivesAnEmptyImage) {
  PersonTracker tracker;
  learn(tracker, 1, kRed);
  const Picture picture = standing(kRed);
  EXPECT_EQ(tracker.update({{}}).person, std::nullopt);
  tracker.forget(1);
  EXPECT_EQ(tracker.update({picture.view()}).person, std::nullopt);
}

}  // namespace
}  // namespace cgsr::person
