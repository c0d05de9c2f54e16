// A drawn person with a marker on the shirt, no faces (6.4.1.1): the marker says who it is and teaches the shirt, which carries on without it.

#include <optional>

#include <gtest/gtest.h>

#include "pipeline/person/tracking/identifier.h"
#include "tests/person/drawn_marker.h"

namespace cgsr::person {
namespace {

constexpr int kWidth = 640, kHeight = 480;
using imaging::Rgb;
constexpr Rgb kWall{0.6, 0.6, 0.6}, kRed{0.7, 0.15, 0.15}, kBlue{0.15, 0.2, 0.7};
constexpr Box kShirt{250, 150, 140, 200};
constexpr Box kMarker{300, 210, 40, 40};
constexpr Label kPerson = 4;
constexpr int kId = 7, kOtherId = 8;

struct Wearer {
  Rgb shirt = kRed;
  std::optional<int> id{};
  double right_px = 0.0;
};

class MarkerFollowing : public testing::Test {
 protected:
  MarkerFollowing() {
    parameters_.marker.enabled = true;
    parameters_.marker.id = kId;
    parameters_.marker.number = kPerson;
    identifier_.emplace(std::nullopt, nullptr, parameters_);
  }

  static void draw(Drawing& drawing, const Wearer& wearer) {
    drawing.fill({kShirt.x + wearer.right_px, kShirt.y, kShirt.width, kShirt.height}, wearer.shirt);
    if (wearer.id) drawing.mark(*wearer.id, {kMarker.x + wearer.right_px, kMarker.y, kMarker.width, kMarker.height});
  }

  PersonSighting look(const std::vector<Wearer>& wearers, int images = 1) {
    Drawing drawing(kWidth, kHeight, kWall);
    for (const Wearer& wearer : wearers) draw(drawing, wearer);
    PeopleInView people;
    for (int i = 0; i < images; ++i) {
      UnlimitedBudget budget;
      people = identifier_->identify(drawing.view(), kPerson, budget);
    }
    return people.person;
  }

  IdentifierParameters parameters_;
  std::optional<Identifier> identifier_;
};

TEST_F(MarkerFollowing, TheMarkerTeachesTheShirtWhichCarriesOnWithoutIt) {
  const auto marked = look({{kRed, kId}}, 60);
  EXPECT_EQ(marked.person, kPerson);
  EXPECT_EQ(marked.source, PersonSource::kMarker);
  EXPECT_NEAR(marked.box.x, kMarker.x, 2.0);
  EXPECT_NEAR(marked.face_px, kMarker.width / parameters_.marker.side_per_face, 3.0);
  for (int image = 0; image < 10; ++image) {
    const auto turned = look({{kRed, std::nullopt, 5.0 * image}});
    EXPECT_EQ(turned.person, kPerson);
    EXPECT_EQ(turned.source, PersonSource::kShirt);
    EXPECT_NEAR(turned.box.x, kShirt.x + 5.0 * image, 2.0);
    EXPECT_NEAR(turned.face_px, marked.face_px, 6.0) << "as near as before";
  }
  EXPECT_EQ(look({}).person, std::nullopt);
}

TEST_F(MarkerFollowing, WithoutTheMarkerNobodyIsKnown) {
  EXPECT_EQ(look({{kRed, std::nullopt}}, 60).person, std::nullopt);
  EXPECT_EQ(look({{kRed, kOtherId}}, 60).person, kStranger);
}

// Another marker on the same shirt: not the person, and the shirt is not taught by it.
TEST_F(MarkerFollowing, AStrangerInTheSameShirtWithAnotherMarkerIsAStranger) {
  look({{kRed, kId}}, 60);
  look({}, 10);
  ASSERT_EQ(look({{kRed, std::nullopt}}).person, kPerson) << "nothing speaks against it";
  const auto stranger = look({{kRed, kOtherId}}, 40);
  EXPECT_EQ(stranger.person, kStranger);
  EXPECT_EQ(stranger.source, PersonSource::kMarker);
  const auto again = look({{kRed, kId}}, 40);
  EXPECT_EQ(again.person, kPerson);
  EXPECT_EQ(look({{kRed, std::nullopt}}).person, kPerson);
}

// Beside the person, another marker says nothing of him, whether his own is seen or not.
TEST_F(MarkerFollowing, AnotherMarkerBesideThePersonDoesNotCount) {
  look({{kRed, kId}}, 60);
  const auto both = look({{kRed, kId}, {kBlue, kOtherId, 190.0}}, 40);
  EXPECT_EQ(both.person, kPerson);
  EXPECT_NEAR(both.box.x, kMarker.x, 2.0);
  const auto turned = look({{kRed, std::nullopt}, {kBlue, kOtherId, 190.0}}, 40);
  EXPECT_EQ(turned.person, kPerson);
  EXPECT_EQ(turned.source, PersonSource::kShirt);
}

// 6.2.4 under a marker: who comes back in another shirt is known by it from then on.
TEST_F(MarkerFollowing, RelearnsAShirtUnderTheMarker) {
  look({{kRed, kId}}, 60);
  EXPECT_EQ(look({{kBlue, std::nullopt}}, 10).person, std::nullopt);
  EXPECT_EQ(look({{kBlue, kId}}, 40).person, kPerson);
  const auto turned = look({{kBlue, std::nullopt}});
  EXPECT_EQ(turned.person, kPerson);
  EXPECT_EQ(turned.source, PersonSource::kShirt);
}

// The light changed, and of the shirt a part alone has still its colours: it is not taken for the shirt, and all of it is learned.
TEST_F(MarkerFollowing, RelearnsAShirtOfWhichAPartAloneIsFound) {
  look({{kRed, kId}}, 60);
  Drawing drawing(kWidth, kHeight, kWall);
  draw(drawing, {kBlue, kId});
  drawing.fill({kShirt.x, kShirt.y, 30, kShirt.height}, kRed);
  UnlimitedBudget budget;
  for (int image = 0; image < 10; ++image)
    EXPECT_EQ(identifier_->identify(drawing.view(), kPerson, budget).person.source, PersonSource::kMarker);
  const auto turned = look({{kBlue, std::nullopt}});
  EXPECT_EQ(turned.person, kPerson);
  EXPECT_NEAR(turned.box.width, kShirt.width, 4.0);
}

TEST_F(MarkerFollowing, SaysWhereTheFaceWouldBeAndSurvivesAnEmptyImage) {
  look({{kRed, kId}}, 60);
  Drawing drawing(kWidth, kHeight, kWall);
  draw(drawing, {kRed, kId});
  UnlimitedBudget budget;
  const auto people = identifier_->identify(drawing.view(), kPerson, budget);
  ASSERT_TRUE(people.expected_face);
  EXPECT_NEAR(people.expected_face->x + people.expected_face->width / 2, 320.0, 3.0);
  EXPECT_LT(people.expected_face->y + people.expected_face->height, kShirt.y);
  EXPECT_EQ(identifier_->identify({}, kPerson, budget).person.person, std::nullopt);
}

}  // namespace
}  // namespace cgsr::person
