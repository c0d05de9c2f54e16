#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/geometry/pose.h"
#include "platform/error.h"

namespace cgsr::app {

/// The rows of two pose files that belong to the same image, by their column `frame`, both of them measured.
struct PosePairs {
  std::vector<geometry::Pose> first;
  std::vector<geometry::Pose> second;
  std::vector<std::int64_t> frames;
  int predicted = 0;  ///< pairs left out: a column `corrected` says of one of them that no image corrected it.
};

/// \return an error naming the file where one has no such column, or they have no frame in common, or all that they have are predictions.
Result<PosePairs> read_pairs(const std::string& first_file, const std::string& second_file);

}  // namespace cgsr::app
