#include "pipeline/localization/matching.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/localization/random_numbers.h"

namespace cgsr::localization {
namespace {

using testing::RandomNumbers;

PerceivedEdge perceived(float x0, float y0, float x1, float y1) {
  const Eigen::Vector2f p0(x0, y0);
  const Eigen::Vector2f p1(x1, y1);
  PerceivedEdge edge;
  edge.middle = 0.5F * (p0 + p1);
  edge.direction = (p1 - p0).normalized();
  edge.half_length = 0.5F * (p1 - p0).norm();
  return edge;
}

ProjectedPiece expected(float x0, float y0, float x1, float y1, int bright_side = 0) {
  const PerceivedEdge edge = perceived(x0, y0, x1, y1);
  ProjectedPiece piece;
  piece.middle = edge.middle;
  piece.direction = edge.direction;
  piece.half_length = edge.half_length;
  piece.bright_side = static_cast<std::int8_t>(bright_side);
  return piece;
}

class Matching : public ::testing::Test {
 protected:
  std::vector<Match> match(const std::vector<ProjectedPiece>& pieces, const std::vector<PerceivedEdge>& edges) {
    SegmentTable table(100);
    for (const PerceivedEdge& edge : edges) table.add(edge);
    table.finish();
    Matcher matcher(100, 100);
    const auto found = matcher.match(pieces, table, rules_);
    std::vector<Match> result(found.begin(), found.end());
    // The table sorts: answer in the numbers of `edges`.
    for (Match& one : result) {
      for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i].middle == table.edges()[one.perceived].middle &&
            edges[i].direction == table.edges()[one.perceived].direction)
          one.perceived = static_cast<std::uint32_t>(i);
      }
    }
    return result;
  }

  MatchingRules rules_;
};

TEST_F(Matching, MeasuresTheFourPropertiesOfFigure43) {
  // A level line of 100 px, a perceived one that overlaps 60 px of it and comes nearer from 4 px to 1 px.
  const auto found = match({expected(100, 100, 200, 100)}, {perceived(140, 104, 220, 100)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].overlap_px(), 60.0F, 1e-3F);
  EXPECT_NEAR(std::abs(found[0].d1_px), 4.0F, 0.02F);
  EXPECT_NEAR(std::abs(found[0].d2_px), 1.0F, 0.02F);
  EXPECT_GT(found[0].d1_px * found[0].d2_px, 0.0F);
  EXPECT_NEAR(found[0].effective_distance_px(), 2.5F, 0.02F);
}

// The two borders of a gap: which of them the expected edge is, its distance alone says.
TEST_F(Matching, RemembersTheLineThatItCouldHaveBeenInstead) {
  const auto of_gap =
      match({expected(100, 100, 200, 100)}, {perceived(110, 100.5F, 190, 100.5F), perceived(110, 103, 190, 103)});
  ASSERT_EQ(of_gap.size(), 1U);
  EXPECT_EQ(of_gap[0].perceived, 0U);
  EXPECT_NEAR(of_gap[0].rival_px, 2.5F, 0.01F);
  const auto of_two_expected =
      match({expected(100, 100, 200, 100), expected(100, 98, 200, 98)}, {perceived(110, 100.5F, 190, 100.5F)});
  ASSERT_EQ(of_two_expected.size(), 1U);
  EXPECT_NEAR(of_two_expected[0].rival_px, 2.0F, 0.01F);
  const auto alone = match({expected(100, 100, 200, 100)}, {perceived(110, 100.5F, 190, 100.5F)});
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_EQ(alone[0].rival_px, Match::kNoRival);
  const auto broken =
      match({expected(100, 100, 200, 100)}, {perceived(100, 101, 140, 101), perceived(150, 101, 200, 101)});
  ASSERT_EQ(broken.size(), 2U);
  EXPECT_EQ(broken[0].rival_px, Match::kNoRival) << "two pieces of one line are no rivals";
}

// The two borders of a gap run either way round in a map, and the perceived edge may lie between them.
TEST_F(Matching, ARivalIsAsFarOffWhicheverWayTheEdgesRun) {
  const std::vector<ProjectedPiece> upper{expected(100, 100, 200, 100), expected(200, 100, 100, 100)};
  const std::vector<ProjectedPiece> lower{expected(100, 103, 200, 103), expected(200, 103, 100, 103)};
  const std::vector<PerceivedEdge> between{perceived(110, 101, 190, 101), perceived(190, 101, 110, 101)};
  for (const ProjectedPiece& first : upper) {
    for (const ProjectedPiece& second : lower) {
      for (const PerceivedEdge& edge : between) {
        const auto found = match({first, second}, {edge});
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].projected, 0U);
        EXPECT_NEAR(found[0].rival_px, 3.0F, 0.01F);
      }
    }
  }
}

TEST_F(Matching, ThatIsTooFarTooOblicOrBesideIsNone) {
  EXPECT_EQ(match({expected(100, 100, 200, 100)}, {perceived(100, 130, 200, 130)}).size(), 0U) << "distance";
  EXPECT_EQ(match({expected(100, 100, 200, 100)}, {perceived(100, 90, 200, 120)}).size(), 0U) << "angle";
  EXPECT_EQ(match({expected(100, 100, 200, 100)}, {perceived(205, 100, 290, 100)}).size(), 0U) << "no overlap";
  EXPECT_EQ(match({expected(100, 100, 200, 100)}, {perceived(100, 110, 200, 110)}).size(), 1U);
}

TEST_F(Matching, ContradictingSidesDiscardACandidateByThemselves) {
  // A perceived edge along +x has its brighter side along (0, 1), downwards.
  const auto bright_below = perceived(100, 101, 200, 101);
  const auto bright_above = perceived(200, 101, 100, 101);
  EXPECT_EQ(match({expected(100, 100, 200, 100, 1)}, {bright_below}).size(), 1U);
  EXPECT_EQ(match({expected(100, 100, 200, 100, 1)}, {bright_above}).size(), 0U);
  EXPECT_EQ(match({expected(100, 100, 200, 100, -1)}, {bright_above}).size(), 1U);
  EXPECT_EQ(match({expected(100, 100, 200, 100, -1)}, {bright_below}).size(), 0U);
  EXPECT_EQ(match({expected(100, 100, 200, 100, 0)}, {bright_above}).size(), 1U);
  EXPECT_EQ(match({expected(200, 100, 100, 100, 1)}, {bright_above}).size(), 1U);
}

// Both borders of a tape, displaced by more than its width: sides tell them apart where nearness would not.
TEST_F(Matching, SidesKeepTheTwoBordersOfATapeApart) {
  const auto found = match({expected(100, 100, 200, 100, 1), expected(100, 106, 200, 106, -1)},
                           {perceived(100, 107, 200, 107), perceived(200, 113, 100, 113)});
  ASSERT_EQ(found.size(), 2U);
  for (const Match& one : found) EXPECT_EQ(one.projected, one.perceived);
}

TEST_F(Matching, AnEdgeInPiecesIsMatchedWithEachOfThem) {
  const auto found =
      match({expected(50, 100, 250, 100)}, {perceived(52, 101, 110, 101), perceived(118, 101, 180, 101),
                                            perceived(186, 101, 249, 101), perceived(60, 110, 240, 110)});
  EXPECT_EQ(std::count_if(found.begin(), found.end(), [](const Match& one) { return one.perceived < 3; }), 3)
      << "broken, and the whole line 10 px away must not take its place";
  EXPECT_EQ(found.size(), 3U);
}

TEST_F(Matching, APerceivedEdgeAlongSeveralExpectedOnesIsMatchedWithEach) {
  const auto found = match({expected(50, 100, 120, 100), expected(120, 100, 240, 100)}, {perceived(50, 101, 240, 101)});
  EXPECT_EQ(found.size(), 2U);
}

TEST_F(Matching, AStretchIsTakenOnce) {
  const auto found = match({expected(50, 100, 150, 100), expected(50, 106, 150, 106)}, {perceived(50, 101, 150, 101)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].projected, 0U);
}

// The runs of bins leave out only what the angle forbids: as many matches as a search over all pairs.
TEST_F(Matching, DirectionsAtTheTurnsEndAreNotLost) {
  for (int degree = 0; degree < 360; ++degree) {
    const float angle = static_cast<float>(degree) * 0.0174533F;
    const float off = angle + 0.15F;
    const Eigen::Vector2f d(40.0F * std::cos(angle), 40.0F * std::sin(angle));
    const Eigen::Vector2f e(40.0F * std::cos(off), 40.0F * std::sin(off));
    for (const int side : {-1, 0, 1}) {
      const auto found = match({expected(160 - d.x(), 120 - d.y(), 160 + d.x(), 120 + d.y(), side)},
                               {perceived(160 - e.x(), 120 - e.y(), 160 + e.x(), 120 + e.y())});
      EXPECT_EQ(found.size(), side >= 0 ? 1U : 0U) << degree << " " << side;
    }
  }
}

TEST_F(Matching, IsWithinItsCapacity) {
  RandomNumbers random(7);
  std::vector<ProjectedPiece> pieces;
  std::vector<PerceivedEdge> edges;
  for (int i = 0; i < 400; ++i) {
    const auto x = static_cast<float>(random.uniform(0, 300));
    const auto y = static_cast<float>(random.uniform(0, 200));
    pieces.push_back(expected(x, y, x + 20.0F, y + 1.0F));
    edges.push_back(perceived(x + 1.0F, y, x + 22.0F, y));
  }
  EXPECT_LE(match(pieces, edges).size(), 200U);
}

// A sheet's print beside the sheet's border: as long together, and next to nothing against it.
TEST(ASegmentTable, HearsLittleOfManyShortEdges) {
  SegmentTable border(100);
  SegmentTable print(100);
  PerceivedEdge long_one = perceived(10.0F, 10.0F, 130.0F, 10.0F);
  long_one.contrast = 100.0F;
  border.add(long_one);
  for (int i = 0; i < 12; ++i) {
    const float y = 20.0F + 5.0F * static_cast<float>(i);
    PerceivedEdge letter = perceived(20.0F, y, 30.0F, y);
    letter.contrast = 100.0F;
    print.add(letter);
  }
  border.finish();
  print.finish();
  EXPECT_FLOAT_EQ(border.weighted_length(), 120.0F);
  EXPECT_FLOAT_EQ(print.whole_length(), 120.0F) << "the solution and the search take them as they are";
  EXPECT_LT(print.weighted_length(), 0.2F * border.weighted_length());
  EXPECT_GT(print.weighted_length(), 0.0F);
}

}  // namespace
}  // namespace cgsr::localization
