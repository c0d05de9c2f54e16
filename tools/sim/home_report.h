#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "platform/error.h"

namespace cgsr::sim {

/// What `cgsr sim home --report` was asked for.
struct HomeReportRequest {
  std::uint32_t first_seed = 0;
  int homes = 200;  ///< with the seeds that follow.
  std::filesystem::path folder;
  bool force = false;
};

/// Draws the homes and writes how they are distributed: homes.csv (a row per home), distributions.json, distributions.txt, and homes.png, the
/// first twelve from above with their lamps and the way through them.
/// \return distributions.txt; an error when the folder is a file or not empty without `force`, or when a seed gives no home.
Result<std::string> report_homes(const HomeReportRequest& request);

}  // namespace cgsr::sim
