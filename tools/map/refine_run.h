#pragma once

#include <optional>
#include <string>

#include "pipeline/mapping/parameters.h"
#include "platform/error.h"

namespace cgsr::app {

/// The command line of `cgsr map refine`; empty texts were not given.
struct RefineOptions {
  std::string map;
  std::string camera;
  std::string input;
  std::string poses;
  std::string odometry;
  std::string mount;
  std::string output;
  std::string proposals;
  std::string picture;
  std::string json;
  double sigma_m = 0.05;   ///< of the given poses, where their file does not say.
  double sigma_deg = 1.0;  ///< likewise.
  bool force = false;
  mapping::RefineParameters parameters;
};

/// Reads everything, refines, writes the map, the proposals and the report, and prints what came of each part.
/// \return what cannot be read, is not as expected, or cannot be written: file, line, value, what was expected.
Result<void> run_refine(const RefineOptions& options);

}  // namespace cgsr::app
