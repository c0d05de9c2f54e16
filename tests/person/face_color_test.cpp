// The third classifier: skin and hair where the head was, when neither face nor shirt is seen (6.3); and the light on a shirt.

#include <cmath>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "tests/person/drawn_people.h"

namespace cgsr::person {
namespace {

constexpr Rgb kSkin{0.75, 0.5, 0.4}, kHair{0.25, 0.15, 0.1};

void draw_head(Picture& picture, const Box& face, const Rgb& front = kSkin) {
  picture.fill(face, front);
  picture.fill({face.x, face.y - 12, face.width, 12}, kHair);
}

Picture somebody(const Rgb& shirt, const Box& face = kFaceBox) {
  Picture picture = standing(shirt);
  draw_head(picture, face);
  return picture;
}

void train(PersonTracker& tracker, const Rgb& shirt, Label person = 1) {
  const Picture picture = somebody(shirt);
  for (int image = 0; image < 30; ++image) tracker.update({picture.view(), face_of(person)});
  ASSERT_TRUE(tracker.shirts().knows(person));
  ASSERT_TRUE(tracker.face_colors().knows(person));
  pass_to_next_look(tracker, picture);
}

TEST(FaceColor, CarriesAPersonWhoseShirtIsCovered) {
  PersonTracker tracker;
  train(tracker, kRed);
  Box face = kFaceBox;
  for (int image = 0; image < 40; ++image) {
    face.x += 2;
    Picture picture;
    draw_head(picture, face);
    const auto sighting = tracker.update({picture.view()});
    ASSERT_EQ(sighting.person, 1) << image;
    EXPECT_EQ(sighting.source, PersonSource::kFaceColor);
    EXPECT_NEAR(sighting.box.x, face.x, 12.0) << image;
    EXPECT_EQ(sighting.face_px, kFaceBox.width);
  }
}

TEST(FaceColor, IsFollowedWhenTurnedAwayByTheHairAlone) {
  PersonTracker tracker;
  train(tracker, kRed);
  Picture picture;
  draw_head(picture, kFaceBox, kHair);
  for (int image = 0; image < 20; ++image) EXPECT_EQ(tracker.update({picture.view()}).person, 1) << image;
}

TEST(FaceColor, ThatSeveralPeopleHaveIsTheirsWhoseHeadIsFollowed) {
  PersonTracker tracker;
  train(tracker, kRed);
  train(tracker, kBlue, 2);
  const Picture covered = somebody(kWall);
  for (const auto& [person, shirt] : {std::pair{1, kRed}, {2, kBlue}, {1, kRed}}) {
    while (!tracker.face_is_due()) tracker.update({somebody(shirt).view()});  // the last face names whom it is above
    ASSERT_EQ(tracker.update({somebody(shirt).view()}).person, person);
    for (int image = 0; image < 10; ++image) {
      const auto sighting = tracker.update({covered.view()});
      EXPECT_EQ(sighting.person, person) << image;
      EXPECT_EQ(sighting.source, PersonSource::kFaceColor) << image;
    }
  }
}

TEST(FaceColor, IsNoProofElsewhereNorForever) {
  PersonTracker tracker;
  train(tracker, kRed);
  Picture other;
  draw_head(other, {20, 120, 40, 40});
  EXPECT_EQ(tracker.update({other.view()}).person, std::nullopt) << "skin that was not there an image before";
  const Picture picture = somebody(kWall);
  tracker.update({somebody(kRed).view()});
  const FaceColorParameters parameters;
  for (int image = 0; image < parameters.max_images; ++image)
    EXPECT_EQ(tracker.update({picture.view()}).source, PersonSource::kFaceColor) << image;
  EXPECT_EQ(tracker.update({picture.view()}).person, std::nullopt) << "neither face nor shirt for long";
}

TEST(FaceColor, GoesWithThePerson) {
  PersonTracker tracker;
  train(tracker, kRed);
  const Picture empty;
  for (int image = 0; image < 40; ++image) EXPECT_EQ(tracker.update({empty.view()}).person, std::nullopt) << image;
  PersonTracker before_skin;
  train(before_skin, kRed);
  const Picture wall(kSkin);
  for (int image = 0; image < 40; ++image) EXPECT_EQ(before_skin.update({wall.view()}).person, std::nullopt) << image;
}

TEST(FaceColor, TakesNoPartWhereItIsSwitchedOff) {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  PersonTracker tracker(parameters);
  for (int image = 0; image < 30; ++image) tracker.update({somebody(kRed).view(), face_of(1)});
  pass_to_next_look(tracker, somebody(kRed));
  EXPECT_EQ(tracker.update({somebody(kWall).view()}).person, std::nullopt);
}

// Skin where a stranger's face was just decided on is his until faces are looked for again.
TEST(FaceColor, IsAStrangersWhereHisFaceWas) {
  PersonTracker tracker;
  train(tracker, kRed);
  const Picture covered = somebody(kWall);
  while (!tracker.face_is_due()) tracker.update({covered.view()});
  ASSERT_EQ(tracker.update({covered.view(), face_of(std::nullopt)}).source, PersonSource::kFace);
  ASSERT_FALSE(tracker.face_is_due());
  const auto between = tracker.update({covered.view()});
  EXPECT_EQ(between.source, PersonSource::kFaceColor);
  EXPECT_EQ(between.person, kStranger);
  ASSERT_TRUE(tracker.face_is_due());
  EXPECT_EQ(tracker.update({covered.view()}).person, 1) << "his face is gone";
}

// 6.3.1: what has the shirt's colours and is not below the head is none, and the head's colours teach the shirt so.
TEST(FaceColor, ShowsThatWhatLooksLikeTheShirtIsNone) {
  PersonTracker tracker;
  train(tracker, kRed);
  Picture picture;
  draw_head(picture, kFaceBox);
  picture.fill({20, 150, 60, 60}, {kRed.r, kRed.g + 0.03, kRed.b + 0.03});
  EXPECT_EQ(tracker.update({picture.view()}).source, PersonSource::kFaceColor);
  for (int image = 0; image < 5; ++image) EXPECT_EQ(tracker.update({picture.view()}).person, 1);
  Picture alone;
  alone.fill({20, 150, 60, 60}, {kRed.r, kRed.g + 0.03, kRed.b + 0.03});
  for (int image = 0; image < 20; ++image) tracker.update({alone.view()});
  EXPECT_EQ(tracker.update({alone.view()}).person, std::nullopt) << "the head is gone; the chair is not the shirt";
}

Rgb in_light(const Rgb& color, double r, double g, double b) {
  return {color.r * r, color.g * g, color.b * b};
}

// A shirt as a camera sees it: shaded from its middle to its sides, with noise. Of a single exact colour, one light's codes are not another's.
Picture in_camera(const Rgb& shirt, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-0.02, 0.02);
  Picture picture(in_light(kWall, shirt.r / kRed.r, shirt.g / kRed.g, shirt.b / kRed.b));
  for (double y = kShirtBox.y; y < kShirtBox.y + kShirtBox.height; y += 2) {
    for (double x = kShirtBox.x; x < kShirtBox.x + kShirtBox.width; x += 2) {
      const double shade = 1.0 - 0.2 * std::abs(x - 160.0) / 40.0;
      picture.fill({x, y, 2, 2},
                   {shirt.r * shade + noise(random), shirt.g * shade + noise(random), shirt.b * shade + noise(random)});
    }
  }
  return picture;
}

PersonTrackerParameters with_shirt_alone() {
  PersonTrackerParameters parameters;
  parameters.face_color.enabled = false;
  return parameters;
}

void learn_in_camera(PersonTracker& tracker) {
  for (unsigned image = 0; image < 15; ++image) tracker.update({in_camera(kRed, image).view(), face_of(1)});
  for (unsigned image = 0; image < 6; ++image) ASSERT_EQ(tracker.update({in_camera(kRed, image).view()}).person, 1);
}

// Eq. 3.1 and 6.2.4, without a face.
TEST(ShirtInAnotherLight, IsFollowedWhileTheLightChangesSlowly) {
  PersonTracker tracker(with_shirt_alone());
  learn_in_camera(tracker);
  int found = 0;
  for (unsigned image = 0; image < 300; ++image) {
    const double gain = 1.0 - 0.4 * image / 300.0;
    found += tracker.update({in_camera(in_light(kRed, gain, gain, 1.0), image).view()}).person == 1 ? 1 : 0;
  }
  EXPECT_GE(found, 280) << "an image or two at each loss, where it is looked for in the new light";
}

TEST(ShirtInAnotherLight, IsFoundAgainWhenTheLightChangesAtOnce) {
  PersonTracker tracker(with_shirt_alone());
  learn_in_camera(tracker);
  int found = 0;
  for (unsigned image = 0; image < 10; ++image)
    found += tracker.update({in_camera(in_light(kRed, 0.6, 0.5, 0.6), image).view()}).person == 1 ? 1 : 0;
  EXPECT_GE(found, 7);
  const Picture empty(in_light(kWall, 0.6, 0.5, 0.6));
  for (int image = 0; image < 20; ++image) EXPECT_EQ(tracker.update({empty.view()}).person, std::nullopt) << image;
}

}  // namespace
}  // namespace cgsr::person
