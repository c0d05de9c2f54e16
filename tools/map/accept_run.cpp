#include "tools/map/accept_run.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "pipeline/world/clean.h"
#include "pipeline/world/compact.h"
#include "pipeline/world/load.h"
#include "pipeline/world/mesh_file.h"
#include "src/output/output_claims.h"
#include "tools/map/proposal_file.h"

namespace cgsr::app {
namespace {

/// The accepted ones, in the order of their numbers.
Result<std::vector<mapping::Proposal>> chosen(const AcceptOptions& options) {
  const auto proposals = read_proposals(options.proposals);
  if (!proposals) return tl::unexpected(proposals.error());
  std::set<int> numbers;
  std::vector<mapping::Proposal> accepted;
  for (const int number : options.numbers) {
    const auto found = proposals->find(number);
    if (found == proposals->end()) {
      return fail(proposals->empty()
                      ? fmt::format("{}: holds no proposal", options.proposals)
                      : fmt::format("--edges: there is no proposal {} in {}: expected numbers in {}..{}", number,
                                    options.proposals, proposals->begin()->first, proposals->rbegin()->first));
    }
    if (!numbers.insert(number).second) return fail(fmt::format("--edges: {} is given twice", number));
    accepted.push_back(found->second);
  }
  if (accepted.empty()) return fail("--edges: names no proposal");
  return accepted;
}

}  // namespace

Result<void> run_accept(const AcceptOptions& options) {
  OutputClaims files(options.force);
  files.reads(options.map, "the map");
  files.reads(options.proposals, "--proposals");
  files.writes(options.output, "--output", compact_map());
  if (auto claimed = files.claim(); !claimed) return claimed;
  if (std::filesystem::path(options.map).extension() != ".obj") {
    return fail(fmt::format("{}: is no OBJ map: expected the one that cgsr map refine wrote", options.map));
  }
  const auto accepted = chosen(options);
  if (!accepted) return tl::unexpected(accepted.error());
  const world::LoadOptions load;
  auto soup = world::read_mesh_file(options.map, load);
  if (!soup) return tl::unexpected(soup.error());
  for (const mapping::Proposal& line : *accepted) {
    const auto first = static_cast<std::uint32_t>(soup->points.size());
    soup->points.push_back(line.a.cast<float>());
    soup->points.push_back(line.b.cast<float>());
    soup->lines.push_back({first, first + 1});
  }
  const auto map = world::clean(*soup, load.weld_m, load.lies_on_m);
  if (!map) return fail(fmt::format("{}: {}", options.map, map.error().message));
  if (auto written = world::write_compact(*map, options.output); !written) return written;
  const auto drawn = std::ranges::count(map->edges, world::EdgeKind::kDrawn, &world::Edge::kind);
  fmt::print("{}: {} edges, {} of them drawn by {} accepted proposals\n", options.output, map->edges.size(), drawn,
             accepted->size());
  return {};
}

}  // namespace cgsr::app
