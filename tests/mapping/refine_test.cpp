#include "pipeline/mapping/refine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/mapping/moved_parts.h"
#include "pipeline/mapping/observe.h"
#include "pipeline/mapping/propose.h"
#include "tests/mapping/furnished_room.h"

namespace cgsr::mapping {
namespace {

using testing::elastic;
using ::testing::HasSubstr;
using testing::moved_room_as_obj;
using testing::room_as_obj;
using testing::small_camera;
using testing::views_of;

double mean_error(const std::vector<Eigen::Vector3d>& corners, const std::vector<Eigen::Vector3d>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) sum += (corners[i] - truth[i]).norm();
  return sum / static_cast<double>(corners.size());
}

TEST(Refine, LeavesAMapAloneThatIsRight) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  auto views = views_of(text, 0.0, 0.0, 40, 1);

  const Refined refined = refine(map, views, small_camera(), {});

  for (std::size_t i = 0; i < refined.corners.size(); ++i) {
    EXPECT_LT((refined.corners[i] - map.measured()[i]).norm(), 0.002) << i;
  }
}

// Things that are N(0, 5 cm) beside where they stand come back, seen from poses that are 5 cm off themselves. What is left is mostly common to
// all: only the given poses and the things themselves say where the whole is.
TEST(Refine, PutsThingsBackThatWereMeasuredWrongly) {
  const auto truth = parse_obj(room_as_obj(), "room");
  ASSERT_TRUE(truth);
  for (std::uint32_t seed = 1; seed <= 3; ++seed) {
    const std::string text = moved_room_as_obj(0.05, seed);
    const auto file = parse_obj(text, "room");
    ASSERT_TRUE(file);
    ElasticMap map = elastic(*file, text);
    std::vector<geometry::Pose> true_poses;
    auto views = views_of(room_as_obj(), 0.3, 1.0, 40, seed, &true_poses);
    RefineParameters parameters;
    parameters.correlated_images = 1.0;  // theirs are not

    const Refined refined = refine(map, views, small_camera(), parameters);

    const auto points = map.points(*file, refined.corners);
    const double before = mean_error(file->points, truth->points);
    const double after = mean_error(points, truth->points);
    EXPECT_GT(before, 0.03) << seed;
    EXPECT_LT(after, 0.02) << seed;
    EXPECT_LT(after, 0.5 * before) << seed;
    double pose_error = 0.0;
    for (std::size_t i = 0; i < views.size(); ++i) {
      pose_error += (views[i].X_WC.translation() - true_poses[i].translation()).norm() / 40.0;
    }
    EXPECT_LT(pose_error, 0.02) << seed;
  }
}

// Poses that are all off by the same are taken to err together: what they say of the way between images stays.
TEST(Refine, KeepsTheWayBetweenPosesWhoseErrorLasts) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  std::vector<geometry::Pose> true_poses;
  auto views = views_of(text, 0.3, 0.0, 20, 4, &true_poses);
  geometry::Vector6d off = geometry::Vector6d::Zero();
  off.head<2>() << 0.06, -0.04;
  for (View& view : views) {
    view.given.X_WC = view.X_WC = geometry::moved(view.X_WC, off);
    view.edges = localization::SegmentTable(1);  // and nothing else says where it was
    view.X_CB.reset();
  }
  auto corners = map.measured();

  const Adjusted adjusted = adjust(map, corners, views, {}, {}, small_camera(), {}, false);

  EXPECT_TRUE(adjusted.solved);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_LT((views[i].X_WC.translation() - views[i].given.X_WC.translation()).norm(), 1e-6) << i;
  }
}

double off_its_end_px(const EndMatch& match, const ElasticMap& map, const View& view) {
  const Eigen::Vector3d p_C = view.X_WC.inverse() * map.corners()[match.corner];
  const geometry::Camera camera = small_camera();
  const Eigen::Vector2d pixel(camera.fx_px * p_C.x() / p_C.z() + camera.cx_px,
                              camera.fy_px * p_C.y() / p_C.z() + camera.cy_px);
  return match.direction.dot(pixel) - match.offset_px;
}

// Lines are directed by what is brighter, edges of a map by its file.
localization::SegmentTable every_other_turned(const localization::SegmentTable& lines) {
  localization::SegmentTable turned(lines.size());
  bool turns = false;
  for (localization::PerceivedEdge line : lines.edges()) {
    if (turns) line.direction = -line.direction;
    turns = !turns;
    turned.add(line);
  }
  turned.finish();
  return turned;
}

TEST(Observe, LinesEndAtTheCornersOfTheirEdges) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  const ElasticMap map = elastic(*file, text);
  auto views = views_of(text, 0.0, 0.0, 20, 1);
  for (View& view : views) view.edges = every_other_turned(view.edges);

  const Observed observed = observe(map, views, small_camera(), {}, 4.0F);

  ASSERT_GT(observed.ends.size(), 100U);
  for (const EndMatch& match : observed.ends) EXPECT_NEAR(off_its_end_px(match, map, views[match.view]), 0.0, 0.6);
}

// A sheet's edges hold it across. Shown by its lower and upper edge alone, only where these end says how far along them it hangs.
TEST(Adjust, LinesThatEndHoldACornerAlongThem) {
  const std::string truth = room_as_obj();
  const auto right = parse_obj(truth, "room");
  ASSERT_TRUE(right);
  auto points = right->points;
  std::vector<std::uint32_t> of_sheet;
  for (const auto& face : right->faces) {
    if (right->parts[face.part] == "sheet") of_sheet = face.corners;
  }
  for (const std::uint32_t corner : of_sheet) points[corner].y() += 0.04;
  const std::string text = obj_text(*right, points, {});
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  const ElasticMap map = elastic(*file, text);
  const auto is_level = [](const LineMatch& match) { return std::abs(match.normal.y()) > 0.8; };
  for (const bool with_ends : {false, true}) {
    auto views = views_of(truth, 0.0, 0.0, 20, 1);
    Observed observed = observe(map, views, small_camera(), {}, 16.0F);
    std::erase_if(observed.matches, [&](const LineMatch& match) { return !is_level(match); });
    auto corners = map.measured();

    const std::vector<EndMatch> ends = with_ends ? observed.ends : std::vector<EndMatch>{};
    adjust(map, corners, views, observed.matches, ends, small_camera(), {}, false);

    const std::uint32_t corner = map.corner_of_point(of_sheet[0]);
    const double off = std::abs(corners[corner].y() - right->points[of_sheet[0]].y());
    if (with_ends) {
      EXPECT_LT(off, 0.01);
    } else {
      EXPECT_GT(off, 0.03);
    }
  }
}

// A part may be turned more easily than it may be larger.
TEST(ElasticMap, TiesHoldAPartsSizeMoreThanItsDirection) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  const ElasticMap map = elastic(*file, text);
  ASSERT_FALSE(map.ties().empty());
  const RefineParameters parameters;
  for (const Tie& tie : map.ties()) {
    const double length = (map.measured()[tie.a] - map.measured()[tie.b]).norm();
    EXPECT_NEAR(tie.along_m, std::hypot(parameters.shape_sigma_m, parameters.size_share * length), 1e-12);
    EXPECT_NEAR(tie.across_m, std::hypot(parameters.shape_sigma_m, parameters.turn_sigma_rad * length), 1e-12);
    EXPECT_LE(tie.along_m, tie.across_m);
  }
}

TEST(Refine, SaysHowWellACornerIsKnown) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  auto views = views_of(text, 0.3, 0.0, 40, 2);
  const Refined refined = refine(map, views, small_camera(), {});
  ASSERT_EQ(refined.sigma_m.size(), refined.corners.size());
  for (std::size_t i = 0; i < refined.corners.size(); ++i) {
    EXPECT_GT(refined.sigma_m[i], 0.0);
    EXPECT_LE(refined.sigma_m[i], map.sigmas()[i] * 1.001);
  }
}

// What stands in the room and not in the map is proposed, and nothing else is.
TEST(Propose, FindsAChairThatIsNotInTheMap) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  auto views = views_of(testing::chair_as_obj(), 0.2, 0.0, 60, 3);
  refine(map, views, small_camera(), {});

  const auto proposals = propose_edges(map, views, small_camera(), {}, {});

  EXPECT_GE(proposals.size(), 4U);
  for (const Proposal& proposal : proposals) {
    for (const Eigen::Vector3d& p : {proposal.a, proposal.b}) {
      EXPECT_LT((p - Eigen::Vector3d(2.4, 2.0, 0.225)).cwiseAbs().x(), 0.25);
      EXPECT_LT((p - Eigen::Vector3d(2.4, 2.0, 0.225)).cwiseAbs().y(), 0.25);
      EXPECT_LT((p - Eigen::Vector3d(2.4, 2.0, 0.225)).cwiseAbs().z(), 0.275);
    }
    EXPECT_GE(proposal.images, ProposeParameters{}.min_support);
  }
}

TEST(Propose, FindsNothingWhereTheMapIsWhole) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  const ElasticMap map = elastic(*file, text);
  const auto views = views_of(text, 0.2, 0.0, 60, 3);
  EXPECT_TRUE(propose_edges(map, views, small_camera(), {}, {}).empty());
}

// The room's map with its chair elsewhere.
std::string with_chair_moved(const Eigen::Vector3d& by) {
  const auto truth = parse_obj(testing::chair_as_obj(), "room");
  if (!truth) return {};
  auto points = truth->points;
  for (const auto& face : truth->faces) {
    if (truth->parts[face.part] != "chair") continue;
    for (const std::uint32_t corner : face.corners) points[corner] = truth->points[corner] + by;
  }
  return obj_text(*truth, points, {});
}

// A chair that stands half a metre from where the map has it is found there, and its edges are proposed; the map keeps it where it was.
TEST(MovedParts, FindsTheChairWhereItStandsNow) {
  const std::string text = with_chair_moved({0.4, 0.3, 0.0});
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  auto views = views_of(testing::chair_as_obj(), 0.2, 0.0, 60, 3);
  refine(map, views, small_camera(), {});
  const auto before = map.corners();

  const auto moved = find_moved_parts(map, views, small_camera(), {});

  ASSERT_EQ(moved.size(), 1U);
  EXPECT_EQ(map.parts()[moved[0].part].name, "chair");
  Eigen::Vector3d measured = Eigen::Vector3d::Zero();
  for (const std::uint32_t corner : map.parts()[moved[0].part].corners) measured += map.measured()[corner] / 8.0;
  EXPECT_LT((measured + moved[0].shift - Eigen::Vector3d(2.4, 2.0, 0.225)).norm(), 0.03);
  EXPECT_GE(moved[0].edges.size(), 4U);
  for (const Proposal& edge : moved[0].edges) {
    EXPECT_EQ(edge.part, "chair");
    EXPECT_LT(edge.rms_px, 2.0);
    EXPECT_LT((edge.a - Eigen::Vector3d(2.4, 2.0, 0.225)).cwiseAbs().maxCoeff(), 0.26);
  }
  EXPECT_EQ(map.corners(), before);
}

// What does not reach the floor in the map, as a chair whose legs are not in it, may have been measured too high or too low.
TEST(MovedParts, FindsWhatWasMeasuredAtAnotherHeightToo) {
  const std::string text = with_chair_moved({0.4, 0.3, 0.07});
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  auto views = views_of(testing::chair_as_obj(), 0.2, 0.0, 60, 3);
  refine(map, views, small_camera(), {});

  const auto moved = find_moved_parts(map, views, small_camera(), {});

  ASSERT_EQ(moved.size(), 1U);
  EXPECT_LT((moved[0].shift - Eigen::Vector3d(-0.4, -0.3, -0.07)).norm(), 0.03);
}

TEST(MovedParts, FindsNoneWhereTheMapIsRight) {
  const std::string text = testing::chair_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  ElasticMap map = elastic(*file, text);
  const auto views = views_of(text, 0.2, 0.0, 60, 3);
  EXPECT_TRUE(find_moved_parts(map, views, small_camera(), {}).empty());
}

TEST(ElasticMap, KnowsItsParts) {
  const std::string text = room_as_obj();
  const auto file = parse_obj(text, "room");
  ASSERT_TRUE(file);
  const ElasticMap map = elastic(*file, text);
  std::vector<std::string> names;
  for (const Part& part : map.parts()) names.push_back(part.name);
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("room", "chest", "box", "shelf", "bench", "sheet", "sheet_2"));
}

TEST(ElasticMap, RefusesAMapThatIsNotTheFiles) {
  const auto file = parse_obj("v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n", "other");
  ASSERT_TRUE(file);
  world::Map map;
  map.vertices = {{7.0F, 0.0F, 0.0F}};
  const auto made = ElasticMap::make(*file, map, {});
  ASSERT_FALSE(made);
  EXPECT_THAT(made.error().message, HasSubstr("(7, 0, 0)"));
}

}  // namespace
}  // namespace cgsr::mapping
