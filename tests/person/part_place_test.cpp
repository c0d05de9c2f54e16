// A part of known size among others of its colours, drawn as labels.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/person/colors/part_place.h"

namespace cgsr::person {
namespace {

constexpr int kColumns = 160, kRows = 120;
constexpr std::uint16_t kPart = 2;
constexpr Box kPlace{60, 40, 20, 30};

struct Labels {
  std::vector<std::uint16_t> labels = std::vector<std::uint16_t>(std::size_t{kColumns} * kRows);

  // What lies in the image of a box, one pixel of so many.
  void fill(const Box& box, std::uint16_t label = kPart, int one_of = 1) {
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kColumns; ++x) {
        const bool inside = x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height;
        if (inside && (7 * x + 3 * y) % one_of == 0) labels[static_cast<std::size_t>(y * kColumns + x)] = label;
      }
    }
  }
  [[nodiscard]] LabelImage view() const { return {labels.data(), kColumns, kRows, kColumns}; }
};

// The part before a road that has some of its colours, and beside a pillar that has all of them.
Labels among_others(const Box& part) {
  Labels labels;
  labels.fill({0, 60, kColumns, 60}, kPart, 3);
  labels.fill({100, 0, 30, kRows});
  labels.fill(part);
  return labels;
}

PartPlace begun(const Labels& labels, const PartPlaceParameters& parameters = {}) {
  PartPlace place(parameters);
  place.begin(labels.view(), kPart, kPlace);
  return place;
}

double distance(const Box& a, const Box& b) {
  return std::hypot(a.x + a.width / 2 - b.x - b.width / 2, a.y + a.height / 2 - b.y - b.height / 2);
}

TEST(PartPlace, IsFollowedWherePartAndBackgroundAreOneBlob) {
  Box part = kPlace;
  PartPlace place = begun(among_others(part));
  for (int image = 0; image < 20; ++image) {
    part.x += image < 10 ? 2.0 : -3.0;
    part.y += 0.5;
    const auto found = place.follow(among_others(part).view(), kPart);
    ASSERT_TRUE(found) << image;
    EXPECT_LT(distance(*found, part), 3.0) << image;
    EXPECT_NEAR(found->width, kPlace.width, 2.0) << image;
  }
  EXPECT_GT(place.contrast(), 0.3);
}

// A part that comes nearer or goes away, to a third more or less: its size is followed, if not all the way.
TEST(PartPlace, FollowsTheSizeOfThePart) {
  for (const double grows : {1.005, 0.996}) {
    Labels first;
    first.fill(kPlace);
    PartPlace place = begun(first);
    std::optional<Box> found;
    Box part = kPlace;
    for (int image = 0; image < 80; ++image) {
      const double width = part.width * grows, height = part.height * grows;
      part = {part.x - (width - part.width) / 2, part.y - (height - part.height) / 2, width, height};
      Labels labels;
      labels.fill(part);
      found = place.follow(labels.view(), kPart);
    }
    ASSERT_TRUE(found);
    if (grows > 1.0) {
      EXPECT_GT(found->width, 1.1 * kPlace.width);
      EXPECT_LT(found->width, part.width);
    } else {
      EXPECT_LT(found->width, 0.92 * kPlace.width);
      EXPECT_GT(found->width, part.width);
    }
  }
}

TEST(PartPlace, IsKeptWhileThePartIsCovered) {
  PartPlace place = begun(among_others(kPlace));
  Labels covered = among_others(kPlace);
  covered.fill({50, 0, 40, kRows}, 1);
  for (int image = 0; image < 30; ++image) EXPECT_FALSE(place.follow(covered.view(), kPart)) << image;
  Box part = kPlace;
  part.x += 15.0;  // farther than it goes in one image
  const auto found = place.follow(among_others(part).view(), kPart);
  ASSERT_TRUE(found);
  EXPECT_LT(distance(*found, part), 3.0);
}

// Where it is cannot be told from two fifths of it.
TEST(PartPlace, IsNotSoughtAboutWhatIsLeftOfACoveredPart) {
  Labels whole, covered;
  whole.fill(kPlace);
  covered.fill({kPlace.x, kPlace.y, kPlace.width, 0.4 * kPlace.height});
  PartPlace place = begun(whole);
  for (int image = 0; image < 10; ++image) EXPECT_FALSE(place.follow(covered.view(), kPart)) << image;
  EXPECT_EQ(place.place(), kPlace);
}

// What is left of its colours beside the place is not the part.
TEST(PartPlace, IsGivenUpWhereThePartIsGoneForLong) {
  PartPlaceParameters parameters;
  parameters.max_lost = 10;
  PartPlace place = begun(among_others(kPlace), parameters);
  const Labels gone = among_others({});
  for (int image = 0; image < 11; ++image) {
    EXPECT_TRUE(place.place());
    EXPECT_FALSE(place.follow(gone.view(), kPart)) << image;
  }
  EXPECT_FALSE(place.place());
  EXPECT_FALSE(place.follow(among_others(kPlace).view(), kPart)) << "it has to be begun again";
}

TEST(PartPlace, IsOfTheImageAlone) {
  PartPlace place = begun(among_others(kPlace));
  Box part = kPlace;
  for (int image = 0; image < 20; ++image) {
    part.x -= 5.0;  // it walks out of the image
    place.follow(among_others(part).view(), kPart);
  }
  EXPECT_FALSE(place.follow(among_others(part).view(), kPart));
  EXPECT_FALSE(place.follow({}, kPart));
}

TEST(PartPlace, HasTheSizeThatItIsToldWithinBounds) {
  PartPlace place = begun(among_others(kPlace));
  place.resize(1.04);
  ASSERT_TRUE(place.place());
  EXPECT_NEAR(place.place()->width, 1.04 * kPlace.width, 1e-9);
  EXPECT_NEAR(place.place()->height, 1.04 * kPlace.height, 1e-9);
  EXPECT_LT(distance(*place.place(), kPlace), 1e-9);
  for (int image = 0; image < 100; ++image) place.resize(1.04);
  EXPECT_NEAR(place.place()->width, 3.0 * kPlace.width, 1e-9);
  for (int image = 0; image < 100; ++image) place.resize(0.96);
  EXPECT_NEAR(place.place()->width, 0.5 * kPlace.width, 1e-9);
  PartPlace never;
  never.resize(1.04);
  EXPECT_FALSE(never.place());
}

TEST(PartPlace, IsNoneWhereItIsNotBegunOrNotEnabled) {
  const Labels labels = among_others(kPlace);
  PartPlace never;
  EXPECT_FALSE(never.follow(labels.view(), kPart));
  never.begin({}, kPart, kPlace);
  EXPECT_FALSE(never.place());
  never.begin(labels.view(), kPart, {});
  EXPECT_FALSE(never.place());
  PartPlaceParameters off;
  off.enabled = false;
  EXPECT_FALSE(begun(labels, off).place());
}

}  // namespace
}  // namespace cgsr::person
