// Proposals that a person accepts, drawn into the map that the robot loads.
#include "tools/map/accept_run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/render/depth_raster.h"
#include "pipeline/world/load.h"
#include "tests/mapping/furnished_room.h"
#include "tests/support/scratch_folder.h"
#include "tools/map/proposal_file.h"

namespace cgsr::app {
namespace {

using ::testing::HasSubstr;

mapping::Proposal line(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  mapping::Proposal proposal;
  proposal.a = a;
  proposal.b = b;
  proposal.images = 9;
  return proposal;
}

class AcceptRun : public ::testing::Test {
 protected:
  AcceptRun() {
    write("room.obj", mapping::testing::room_as_obj());
    write("proposals.obj", proposals_as_obj(lines));
    options.map = path("room.obj");
    options.proposals = path("proposals.obj");
    options.output = path("accepted.cgsrmap");
    options.numbers = {1, 3};
  }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::stringstream text;
    text << std::ifstream(folder_ / name).rdbuf();
    return text.str();
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string error() {
    const auto done = run_accept(options);
    return done ? "" : done.error().message;
  }

  const std::vector<mapping::Proposal> lines{line({2.0, 2.0, 0.6}, {2.5, 2.0, 0.6}),
                                             line({2.0, 2.5, 0.6}, {2.5, 2.5, 0.6}),
                                             line({2.0, 2.0, 0.6}, {2.0, 2.5, 0.6})};
  AcceptOptions options;

 private:
  test::ScratchFolder folder_;
};

const world::Edge* edge_between(const world::Map& map, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const auto near = [&](std::uint32_t vertex, const Eigen::Vector3d& p) {
    return (map.vertices[vertex].cast<double>() - p).norm() < 1e-3;
  };
  const auto found = std::ranges::find_if(map.edges, [&](const world::Edge& edge) {
    const auto& [from, to] = edge.vertices;
    return (near(from, a) && near(to, b)) || (near(from, b) && near(to, a));
  });
  return found == map.edges.end() ? nullptr : &*found;
}

// The robot's loader reads exactly the accepted ones, and its expectation shows them.
TEST_F(AcceptRun, DrawsWhatWasAcceptedIntoTheMapThatTheRobotLoads) {
  ASSERT_EQ(error(), "");

  const auto map = world::load_map(options.output);
  const auto before = world::load_map(options.map);
  ASSERT_TRUE(map && before);
  EXPECT_EQ(map->edges.size(), before->edges.size() + 2);
  EXPECT_EQ(map->surfaces.size(), before->surfaces.size());
  for (const std::size_t i : {0U, 2U}) {
    const world::Edge* edge = edge_between(*map, lines[i].a, lines[i].b);
    ASSERT_NE(edge, nullptr) << i;
    EXPECT_EQ(edge->kind, world::EdgeKind::kDrawn);
  }
  EXPECT_EQ(edge_between(*map, lines[1].a, lines[1].b), nullptr) << "was not accepted";
  EXPECT_EQ(read("room.obj"), mapping::testing::room_as_obj());

  geometry::Pose X_WC = geometry::Pose::Identity();
  X_WC.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  X_WC.translation() << 1.0, 2.2, 0.8;
  render::DepthRaster raster(*map, {});
  std::vector<render::VisiblePiece> pieces;
  raster.look(X_WC, mapping::testing::small_camera(), pieces);
  EXPECT_TRUE(std::ranges::any_of(pieces, [&](const render::VisiblePiece& piece) {
    return map->edges[piece.edge].kind == world::EdgeKind::kDrawn;
  }));
}

TEST_F(AcceptRun, TakesTheNumbersOfAFileThatAPersonHasThinnedOut) {
  std::string text = read("proposals.obj");
  text.erase(text.find("l 1 2"), 5);
  text.erase(text.find("o proposal_1"), text.find("v 2.0") - text.find("o proposal_1"));
  write("proposals.obj", text);
  options.numbers = {3};

  ASSERT_EQ(error(), "");

  const auto map = world::load_map(options.output);
  ASSERT_TRUE(map);
  EXPECT_NE(edge_between(*map, lines[2].a, lines[2].b), nullptr);
}

TEST_F(AcceptRun, NamesANumberThatIsNotProposed) {
  options.numbers = {1, 4};
  EXPECT_THAT(error(), HasSubstr("--edges: there is no proposal 4 in "));
  EXPECT_THAT(error(), HasSubstr("expected numbers in 1..3"));
  options.numbers = {2, 2};
  EXPECT_THAT(error(), HasSubstr("--edges: 2 is given twice"));
  EXPECT_FALSE(std::filesystem::exists(options.output));
  write("proposals.obj", proposals_as_obj({}));
  EXPECT_THAT(error(), HasSubstr("holds no proposal"));
}

TEST_F(AcceptRun, RefusesAFileThatRefineDidNotWrite) {
  options.proposals = path("room.obj");
  options.map = path("copy.obj");
  write("copy.obj", mapping::testing::room_as_obj());
  EXPECT_THAT(error(), HasSubstr("room.obj: is no file of proposals: expected one that cgsr map refine --proposals"));
}

TEST_F(AcceptRun, NeverWritesOverWhatItReadsNorOverAnotherKindOfFile) {
  write("accepted.cgsrmap", "a diary");
  EXPECT_THAT(error(), HasSubstr("accepted.cgsrmap"));
  EXPECT_EQ(read("accepted.cgsrmap"), "a diary");
  options.output = path("accepted.obj");
  EXPECT_THAT(error(), HasSubstr(".cgsrmap"));
  options.force = true;
  options.output = options.map;
  EXPECT_THAT(error(), HasSubstr("room.obj"));
  EXPECT_EQ(read("room.obj"), mapping::testing::room_as_obj());
}

TEST(ProposalFile, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& lines) {
    const auto read = parse_proposals(std::string(kProposalsTitle) + "\n" + lines, "p.obj");
    return read ? "" : read.error().message;
  };
  EXPECT_THAT(message("o chair\n"), HasSubstr("p.obj:2: an object is 'chair': expected a name as proposal_1"));
  EXPECT_THAT(message("o proposal_1_seen\nv 0 0 x\n"), HasSubstr("p.obj:3: an end is not three finite numbers"));
  EXPECT_THAT(message("o proposal_1_seen\nv 0 0 1\nl 1 2\n"), HasSubstr("p.obj:4: a line is not between two of the 1"));
  EXPECT_THAT(message("o proposal_1_seen\nv 0 0 1\nv 1 0 1\n"), HasSubstr("proposal 1 has no line"));
  EXPECT_THAT(message("o proposal_1_a\nv 0 0 1\nv 1 0 1\nl 1 2\no proposal_1_b\n"),
              HasSubstr("proposal 1 is there twice"));
  EXPECT_THAT(message("f 1 2 3\n"), HasSubstr("p.obj:2: begins with 'f': expected o, v or l"));
}

}  // namespace
}  // namespace cgsr::app
