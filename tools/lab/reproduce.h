#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"
#include "tools/lab/tracking/options.h"

namespace CLI {
class App;
}

namespace cgsr::lab {

/// What `cgsr reproduce` was asked for.
struct ReproduceOptions {
  std::vector<std::string> names;
  std::optional<std::uint64_t> seed;  ///< nothing: drawn at the run.
  int trials = 0;
  std::string data, json, html, config, videos;
  bool list = false;
  bool no_count = false;
  bool all = false;
  bool store = false;
  bool resume = false;
  bool repeat = false;
  bool page = false;
  bool check_page = false;
  bool force = false;
  std::string results;  ///< folder of the store; empty: docs/results of the source tree.
  TrackingOptions tracking;
};

void add_reproduce(CLI::App& app, ReproduceOptions& options);

/// \return the program's exit code: 1 when the page is checked and wrong; or what went wrong.
Result<int> reproduce(const ReproduceOptions& options);

}  // namespace cgsr::lab
