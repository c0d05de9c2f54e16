#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace CLI {
class App;
}

namespace cgsr::lab {

/// What the tracking benchmark measures, each by itself.
enum class BenchmarkPart : std::uint8_t { kOnePass, kSpatial, kTemporal, kHalfPixel, kRelit, kAbsent, kCost };
inline constexpr std::array<std::string_view, 7> kBenchmarkParts{"one-pass", "spatial", "temporal", "half-pixel",
                                                                 "relit",    "absent",  "cost"};
constexpr std::string_view to_string(BenchmarkPart part) {
  return kBenchmarkParts[static_cast<std::size_t>(part)];
}

/// What `cgsr reproduce tracking-benchmark` was asked for besides what every table takes.
struct TrackingOptions {
  std::vector<std::string> sequences;  ///< folders; none: tracking and people/human3 of the recorded data.
  std::vector<std::string> only;       ///< names of sequences; none: all.
  std::vector<std::string> trackers;   ///< none: all.
  std::vector<std::string> parts;      ///< none: all.
  bool ours_only = false;
  int images = 0;                ///< of each sequence; 0: all.
  int every = 1;                 ///< take each so-many-th start of the robustness parts, which are slow.
  std::uint64_t light_seed = 1;  ///< of the relit variants: fixed, so that peers' boxes on them stay valid.
  std::string output = "out/tracking-benchmark";
  bool no_films = false;
  std::string against;  ///< figures of an earlier run.
  std::string cache;    ///< empty: run_cache_folder().

  [[nodiscard]] bool has(BenchmarkPart part) const;
  [[nodiscard]] bool runs(std::string_view tracker) const;
};

void add_tracking_options(CLI::App& app, TrackingOptions& options);

}  // namespace cgsr::lab
