// Homes drawn from a seed: the same bytes, files that load, rooms that can be driven through by another geometry than the generator's own.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>

#include "hal/sim/generator/free_floor.h"
#include "hal/sim/generator/home.h"
#include "hal/sim/generator/home_files.h"
#include "hal/sim/generator/world_text.h"
#include "hal/sim/home/scenario.h"
#include "hal/sim/worlds/world.h"
#include "platform/config/reader.h"
#include "platform/config/sha256.h"
#include "tests/app/program.h"

namespace cgsr::sim {
namespace {

using app::testing::read_text;
using app::testing::run_cgsr;
using app::testing::ScratchFolder;
using app::testing::write_text;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr std::uint32_t kSeeds = 30;

const std::vector<std::string> kFiles{"world.toml",  "round.toml",      "robot.toml",     "map/map.obj",
                                      "map/map.mtl", "map/camera.yaml", "map/robot.toml", "map/lamp-robot.toml"};

fs::path shipped_robot() {
  return fs::path(CGSR_SOURCE_DIR) / "config/robots/sim-home-round.toml";
}

/// How far a place on the floor is from what stands there, by the built scene's triangles between 5 cm and 1.4 m.
class Things {
 public:
  explicit Things(const Scene& scene) {
    for (const Part& part : scene.parts) {
      if (part.figure >= 0 || !part.casts_shadow) continue;
      for (const auto& triangle : part.mesh.triangles) {
        Corners corners;
        float low = 1e9F;
        float high = -1e9F;
        for (std::size_t i = 0; i < 3; ++i) {
          const Eigen::Vector3f& p = part.mesh.position_m[triangle.corner[i]];
          corners[i] = p.head<2>().cast<double>();
          low = std::min(low, p.z());
          high = std::max(high, p.z());
        }
        if (high > 0.05F && low < 1.4F) triangles_.push_back(corners);
      }
    }
  }

  [[nodiscard]] double distance(const Eigen::Vector2d& p) const {
    double least = 1.0;  // farther is not told apart
    for (const Corners& corners : triangles_) {
      const Eigen::AlignedBox2d box = Eigen::AlignedBox2d(corners[0]).extend(corners[1]).extend(corners[2]);
      if (box.exteriorDistance(p) < least) least = std::min(least, distance(corners, p));
    }
    return least;
  }

 private:
  using Corners = std::array<Eigen::Vector2d, 3>;

  static double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
  static double distance(const Corners& c, const Eigen::Vector2d& p) {
    double least = 1e9;
    int left = 0;
    int right = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector2d along = c[(i + 1) % 3] - c[i];
      const Eigen::Vector2d to = p - c[i];
      const double t = std::clamp(to.dot(along) / std::max(1e-12, along.squaredNorm()), 0.0, 1.0);
      least = std::min(least, (to - t * along).norm());
      const double side = cross(along, to);
      left += side > 0 ? 1 : 0;
      right += side < 0 ? 1 : 0;
    }
    return left == 3 || right == 3 ? 0.0 : least;
  }

  std::vector<Corners> triangles_;
};

// Whoever draws a number, in whatever build, gets this one. A change of the generator changes it, and every home with it: say so in CHANGELOG.md.
TEST(GeneratedHomes, HaveTheSameBytesEverywhere) {
  const auto home = generate_home(7);
  ASSERT_TRUE(home) << home.error().message;
  const std::string text =
      world_as_toml(home->world, "home 7") + scenario_as_toml(*home) + robot_as_toml(*home, "x.toml");
  config::Sha256 sum;
  sum.add(text.data(), text.size());
  EXPECT_EQ(sum.hex(), "913d3be0356af4626c22686c970a0cc9661848e9daebe73b026995e74b5c29e6");
}

TEST(GeneratedHomes, AreWrittenAlikeTwice) {
  ScratchFolder scratch;
  const auto home = generate_home(11);
  const auto again = generate_home(11);
  ASSERT_TRUE(home && again);
  ASSERT_TRUE(write_home(*home, shipped_robot(), scratch.path() / "a"));
  ASSERT_TRUE(write_home(*again, shipped_robot(), scratch.path() / "b"));
  for (const std::string& file : kFiles) {
    EXPECT_FALSE(read_text(scratch / ("a/" + file)).empty()) << file;
    EXPECT_EQ(read_text(scratch / ("a/" + file)), read_text(scratch / ("b/" + file))) << file;
  }
}

TEST(GeneratedHomes, LoadAndCanBeDrivenThrough) {
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    ScratchFolder scratch;
    const auto home = generate_home(seed);
    ASSERT_TRUE(home) << home.error().message;
    ASSERT_TRUE(write_home(*home, shipped_robot(), scratch.path()));
    const auto scenario = load_scenario(scratch.path() / "round.toml", 1);
    ASSERT_TRUE(scenario) << scenario.error().message;
    const auto world = build_world(scenario->world, scenario->world_file);
    ASSERT_TRUE(world) << world.error().message;

    const Things things(world->scene);
    std::set<int> rooms;
    Eigen::Vector2d at(home->route.start.x, home->route.start.y);
    double nearest = 1e9;
    for (const FloorPoint& place : home->route.places) {
      const Eigen::Vector2d to(place.x, place.y);
      const int steps = 1 + static_cast<int>((to - at).norm() / 0.08);
      for (int i = 0; i <= steps; ++i) {
        const Eigen::Vector2d p = at + (to - at) * i / steps;
        nearest = std::min(nearest, things.distance(p));
        rooms.insert(home->plan.room_at(p.x(), p.y()));
      }
      at = to;
    }
    rooms.erase(-1);
    EXPECT_EQ(rooms.size(), home->plan.rooms.size());
    EXPECT_GT(nearest, 0.30);  // the robot is 0.62 m wide; the generator's grid has cells of 5 cm
    EXPECT_NEAR((at - Eigen::Vector2d(home->route.start.x, home->route.start.y)).norm(), 0.0, 1e-9);
  }
}

TEST(GeneratedHomes, KeepToWhatTheyPromise) {
  std::set<std::string> graphs;
  std::map<std::string, int> layouts;
  for (std::uint32_t seed = 100; seed < 160; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const auto home = generate_home(seed);
    ASSERT_TRUE(home) << home.error().message;
    EXPECT_THAT(home->plan.rooms.size(), testing::AllOf(testing::Ge(2U), testing::Le(6U)));
    EXPECT_THAT(home->lights.lamps.size(), testing::AllOf(testing::Ge(1U), testing::Le(3U)));
    for (std::size_t i = 0; i < home->lights.lamps.size(); ++i) {
      EXPECT_GE(home->world.lamp[i].radius_m, 0.02);
      EXPECT_LE(home->world.lamp[i].radius_m, 0.15);
    }
    for (const FloorPlan::Door& door : home->plan.doors())
      EXPECT_GE(door.opening->to - door.opening->from, kMinDoor_m - 1e-9);
    EXPECT_GT(home->furnished.furniture, 0);
    EXPECT_TRUE(std::ranges::any_of(home->world.shape, [](const ShapeSpec& shape) { return !shape.in_map; }));
    graphs.insert(home->plan.door_graph());
    ++layouts[home->plan.layout()];
  }
  EXPECT_GE(graphs.size(), 8U);
  for (const auto& [layout, count] : layouts) EXPECT_LE(count, 3) << layout;
}

// A plan that is turned by half and numbered otherwise has the same graph and layout.
TEST(FloorPlans, AreAlikeHoweverTheyAreTurnedAndNumbered) {
  Draw draw(3, 0);
  auto plan = draw_floor_plan(draw);
  ASSERT_TRUE(plan);
  FloorPlan other = *plan;
  const int last = static_cast<int>(other.rooms.size()) - 1;
  std::reverse(other.rooms.begin(), other.rooms.end());
  for (Room& room : other.rooms) {
    room.lines = {plan->outline.x1 - room.lines.x1, plan->outline.y1 - room.lines.y1, plan->outline.x1 - room.lines.x0,
                  plan->outline.y1 - room.lines.y0};
  }
  for (Wall& wall : other.walls) {
    for (Opening& opening : wall.openings) {
      opening.room_a = last - opening.room_a;
      if (opening.room_b >= 0) opening.room_b = last - opening.room_b;
    }
  }
  EXPECT_EQ(other.door_graph(), plan->door_graph());
  EXPECT_EQ(other.layout(), plan->layout());
  std::erase_if(other.walls, [](const Wall& wall) { return !wall.outer; });
  EXPECT_NE(other.door_graph(), plan->door_graph());
}

TEST(FreeFloors, KnowWhatADiscGetsThrough) {
  FreeFloor floor({0.0, 0.0, 4.0, 3.0});
  floor.add(footprint_of({1.9, 0.0, 2.1, 1.1}));
  floor.add(footprint_of({1.9, 1.9, 2.1, 3.0}));  // leaves a gap of 0.8 m
  const FloorPoint left{0.8, 1.5};
  const FloorPoint right{3.2, 1.5};
  EXPECT_TRUE(floor.reached_from(left, 0.35)[floor.cell_at(right)]);
  EXPECT_FALSE(floor.reached_from(left, 0.45)[floor.cell_at(right)]);
  const auto way = floor.way({0.8, 0.5}, {3.2, 0.5}, 0.35);
  ASSERT_TRUE(way);
  for (std::size_t i = 1; i < way->size(); ++i) EXPECT_TRUE(floor.straight((*way)[i - 1], (*way)[i], 0.35)) << i;
  EXPECT_FALSE(floor.way(left, right, 0.45));
}

// A lamp in the shipped board's reach is seen; one as low as the board, or behind furniture on all sides, is not.
TEST(ProbesSee, WhatThrowsAShadowOnTheBoard) {
  Draw draw(5, 0);
  const auto plan = draw_floor_plan(draw);
  ASSERT_TRUE(plan);
  WorldSpec world;
  Site site(*plan, world, Palette(world.material, Draw(5, 1)));
  const FloorRect floor = plan->rooms[0].floor();
  LampSpec lamp;
  lamp.position_m = {floor.x(), floor.y(), 2.2};
  EXPECT_TRUE(probes_see(site, lamp, {0, 0, 0}));
  lamp.position_m[2] = 1.0;
  EXPECT_FALSE(probes_see(site, lamp, {0, 0, 0}));
  lamp.position_m[2] = 2.2;
  site.reserve({{{floor.x(), floor.y()}, 0.3, 0.3, 0.0}, 2.0, 2.4});
  EXPECT_FALSE(probes_see(site, lamp, {0, 0, 0}));
  EXPECT_TRUE(probes_see(site, lamp, {0, 0, 1}));  // its own shade is not in its way
}

TEST(GeneratedHomesTool, WritesAHomeAndRefusesToWriteOverAFolder) {
  ScratchFolder scratch;
  const auto done = run_cgsr({"home", "--seed", "5", "--output", scratch / "home"}, CGSR_PROGRAM);
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("home 5: "));
  for (const std::string& file : kFiles) EXPECT_TRUE(fs::is_regular_file(scratch / ("home/" + file))) << file;

  write_text(scratch / "home/mine.txt", "mine");
  const auto again = run_cgsr({"home", "--seed", "6", "--output", scratch / "home"}, CGSR_PROGRAM);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.errors, HasSubstr("the folder is not empty; name another one, or --force"));
  EXPECT_THAT(read_text(scratch / "home/world.toml"), HasSubstr("--seed 5"));
  const auto forced = run_cgsr({"home", "--seed", "6", "--output", scratch / "home", "--force"}, CGSR_PROGRAM);
  EXPECT_EQ(forced.exit_code, 0) << forced.errors;
  EXPECT_THAT(read_text(scratch / "home/world.toml"), HasSubstr("--seed 6"));
  EXPECT_EQ(read_text(scratch / "home/mine.txt"), "mine");

  write_text(scratch / "file", "x");
  EXPECT_THAT(run_cgsr({"home", "--seed", "6", "--output", scratch / "file"}, CGSR_PROGRAM).errors,
              HasSubstr("is a file; name a folder"));
}

TEST(GeneratedHomesTool, ReportsHowHomesAreDistributed) {
  ScratchFolder scratch;
  const auto done = run_cgsr({"home", "--seed", "3", "--report", "15", "--output", scratch / "report"}, CGSR_PROGRAM);
  ASSERT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_THAT(done.output, HasSubstr("15 homes, seeds 3 to 17"));
  EXPECT_EQ(read_text(scratch / "report/distributions.txt"), done.output);
  const std::string csv = read_text(scratch / "report/homes.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 16);
  const auto home = generate_home(4);
  ASSERT_TRUE(home);
  EXPECT_THAT(csv, HasSubstr(fmt::format("\n4,\"{}\",{},{:.6g},", home->plan.door_graph(), home->plan.rooms.size(),
                                         home->plan.outline.area())));
  EXPECT_THAT(read_text(scratch / "report/distributions.json"), HasSubstr("\"door_graphs\""));
  EXPECT_FALSE(cv::imread(scratch / "report/homes.png").empty());
  EXPECT_EQ(run_cgsr({"home", "--seed", "3", "--report", "2", "--output", scratch / "report"}, CGSR_PROGRAM).exit_code,
            1);
  EXPECT_NE(run_cgsr({"home", "--seed", "3", "--report", "0", "--output", scratch / "r"}, CGSR_PROGRAM).exit_code, 0);
}

TEST(GeneratedHomesTool, RefusesSeedsThatCannotBe) {
  ScratchFolder scratch;
  EXPECT_FALSE(generate_home(kMaxHomeSeed + 1));
  for (const char* seed : {"-1", "1000000001", "1.5", "many"}) {
    const auto refused = run_cgsr({"home", "--seed", seed, "--output", scratch / "home"}, CGSR_PROGRAM);
    EXPECT_NE(refused.exit_code, 0) << seed;
    EXPECT_THAT(refused.errors, HasSubstr("--seed")) << seed;
    EXPECT_FALSE(fs::exists(scratch / "home")) << seed;
  }
}

}  // namespace
}  // namespace cgsr::sim
