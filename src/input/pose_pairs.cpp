#include "src/input/pose_pairs.h"

#include <fmt/core.h>

#include "src/input/pose_file.h"

namespace cgsr::app {

Result<PosePairs> read_pairs(const std::string& first_file, const std::string& second_file) {
  const auto first = read_poses(first_file);
  if (!first) return tl::unexpected(first.error());
  const auto second = read_poses(second_file);
  if (!second) return tl::unexpected(second.error());
  PosePairs pairs;
  auto other = second->begin();
  for (const PoseRow& row : *first) {
    if (!row.frame || !other->frame) {
      return fail(fmt::format("{}: no column 'frame': it says which poses belong together",
                              row.frame ? second_file : first_file));
    }
    while (other != second->end() && *other->frame < *row.frame) ++other;
    if (other == second->end()) break;
    if (*other->frame != *row.frame) continue;
    if (!row.corrected || !other->corrected) {
      ++pairs.predicted;
      continue;
    }
    pairs.first.push_back(row.X);
    pairs.second.push_back(other->X);
    pairs.frames.push_back(*row.frame);
  }
  if (pairs.frames.empty() && pairs.predicted > 0) {
    return fail(
        fmt::format("{} and {} have {} frames in common, but corrected is 0 in each: expected measured poses, these "
                    "are predictions",
                    first_file, second_file, pairs.predicted));
  }
  if (pairs.frames.empty()) {
    return fail(fmt::format("{} and {} have no frame number in common", first_file, second_file));
  }
  return pairs;
}

}  // namespace cgsr::app
