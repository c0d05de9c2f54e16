// Faces, shirt and person of interest together, in drawn people whose faces the cascade finds; who is who the test says.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/person/tracking/identifier.h"
#include "tests/person/drawn_face.h"
#include "tests/person/drawn_marker.h"

namespace cgsr::person {
namespace {

using imaging::Rgb;
constexpr Rgb kGreyWall{0.5, 0.5, 0.5}, kRedShirt{0.7, 0.15, 0.15}, kBlueShirt{0.15, 0.2, 0.7};
constexpr int kFacePx = 100;

/// Names faces in the order in which they come; an answer takes an image.
class ToldRecognizer final : public FaceRecognizer {
 public:
  explicit ToldRecognizer(std::vector<std::optional<Label>> names) : names_(std::move(names)) {}

  bool ask(FaceQuestion&& question) override {
    face_ = question.face;
    return true;
  }
  std::optional<FaceAnswer> answer() override {
    const auto face = std::exchange(face_, std::nullopt);
    if (!face) return std::nullopt;
    if (std::ranges::find(faces_, *face) == faces_.end()) faces_.push_back(*face);
    const auto place = static_cast<std::size_t>(std::ranges::find(faces_, *face) - faces_.begin());
    FaceMatch match;
    match.confidence = 0.95;
    if (place < names_.size()) match.label = names_[place];
    return FaceAnswer{*face, match};
  }

 private:
  std::vector<std::optional<Label>> names_;
  std::vector<std::uint32_t> faces_;
  std::optional<std::uint32_t> face_;
};

struct Standing {
  int x_px = 320;
  Rgb shirt = kRedShirt;
  bool face = true;
};

class Identifying : public testing::Test {
 protected:
  void make(std::vector<std::optional<Label>> names) {
    identifier_.emplace(detector_of_debian(), std::make_unique<ToldRecognizer>(std::move(names)));
  }

  PeopleInView look(const std::vector<Standing>& people, int images, std::optional<Label> asked = std::nullopt) {
    Drawing drawing(640, 480, kGreyWall);
    for (const Standing& person : people) {
      drawing.fill({person.x_px - 90.0, 240.0, 180.0, 200.0}, person.shirt);
      cv::Mat head(160, 120, CV_8UC1, cv::Scalar(127));
      draw_face(head, 60, 80, kFacePx);
      cv::GaussianBlur(head, head, {}, 2.0);
      if (person.face) drawing.paste(head, person.x_px - 60, 60);
    }
    PeopleInView in_view;
    for (int i = 0; i < images; ++i) {
      UnlimitedBudget budget;
      in_view = identifier_->identify(drawing.view(), asked, budget);
    }
    return in_view;
  }

  std::optional<Identifier> identifier_;
};

TEST_F(Identifying, AFaceSaysWhoItIsAndTheShirtBelowItCarriesOn) {
  make({1});
  const PeopleInView front = look({{}}, 60);
  ASSERT_EQ(front.face_count, 1U) << "the face that is drawn is found";
  EXPECT_EQ(front.faces[0].person, 1);
  EXPECT_EQ(front.person.person, 1);
  const PeopleInView turned = look({{.face = false}}, 20);
  EXPECT_EQ(turned.person.person, 1);
  EXPECT_EQ(turned.person.source, PersonSource::kShirt);
  ASSERT_TRUE(turned.expected_face);
  EXPECT_NEAR(turned.expected_face->x + turned.expected_face->width / 2, 320.0, 20.0) << "above the shirt";
}

// 6.2.2: the latest person of interest stays it while somebody else who is known comes to stand beside him.
TEST_F(Identifying, WhoCameFirstIsOfInterestUntilSomebodyElseIsAskedFor) {
  make({1, 2});
  const Standing first{.x_px = 160}, second{.x_px = 480, .shirt = kBlueShirt};
  ASSERT_EQ(look({first}, 60).person.person, 1);
  const PeopleInView both = look({first, second}, 60);
  ASSERT_EQ(both.face_count, 2U);
  EXPECT_EQ(both.person.person, 1);
  EXPECT_EQ(look({first, second}, 10, 2).person.person, 2) << "asked for";
}

TEST_F(Identifying, WhoIsGoneForLongIsOfInterestNoMore) {
  make({1, 2});
  const Standing first{.x_px = 160}, second{.x_px = 480, .shirt = kBlueShirt};
  ASSERT_EQ(look({first}, 60).person.person, 1);
  const PeopleInView both = look({first, second}, 60);
  ASSERT_EQ(both.face_count, 2U);
  for (const SeenFace& face : both.seen_faces()) ASSERT_EQ(face.person, face.box.x < 320.0 ? 1 : 2);
  int images = 1;
  while (images < 60 && look({second}, 1).person.person != 2) ++images;
  EXPECT_GE(images, 14) << "a few images without him are no reason";
  EXPECT_LT(images, 60);
}

// A stranger beside the person says nothing of him; one whose face is above the shirt that was taken for his does.
TEST_F(Identifying, AStrangerCountsWhereHisFaceIsAboveThePersonsShirt) {
  make({1, std::nullopt});
  const Standing person{.x_px = 160};
  ASSERT_EQ(look({person}, 60, 1).person.person, 1);
  const PeopleInView beside = look({{.x_px = 160, .face = false}, {.x_px = 480, .shirt = kBlueShirt}}, 60, 1);
  ASSERT_EQ(beside.face_count, 1U);
  EXPECT_EQ(beside.faces[0].person, std::nullopt);
  EXPECT_EQ(beside.person.person, 1);
  EXPECT_EQ(beside.person.source, PersonSource::kShirt);

  look({}, 30, 1);
  const PeopleInView above = look({{.x_px = 320}}, 60, 1);
  ASSERT_EQ(above.face_count, 1U);
  EXPECT_EQ(above.person.person, kStranger) << "in the same shirt";
}

}  // namespace
}  // namespace cgsr::person
