#include "tools/lab/tracking/cost.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/counting.h"
#include "tools/lab/trackers.h"

namespace cgsr::lab {
namespace {

constexpr std::array<std::string_view, 6> kFolders{"tracking/coke",      "tracking/jogging", "tracking/lemming",
                                                   "tracking/nightcars", "tracking/tiger1",  "people/human3"};
constexpr int kImages = 60;
constexpr int kPeerImages = 10;  // a peer costs a minute of counting per ten images

Result<Cost> count_one(const Setting& setting, const NamedTracker& named, std::string_view folder) {
  const bool is_peer = !named.options.empty();
  return count_follow(named.name, setting.config_file,
                      {"--input", (*setting.data / folder).string(), "--size", "640x480", "--images",
                       std::to_string(1 + (is_peer ? kPeerImages : kImages))})
      .map([](const Counted& counted) { return counted.image; });
}

}  // namespace

Result<void> add_cost_rows(const Setting& setting, Report& report) {
  if (!setting.data) {
    report.notes.emplace_back("Cost: left out, --data or CGSR_DATA names no folder.");
    return {};
  }
  for (const NamedTracker& named : trackers()) {
    if (!setting.tracking.runs(named.name)) continue;
    Cost all;
    for (const std::string_view folder : kFolders) {
      setting.progress(fmt::format("{} / {}, counting", folder, named.name));
      const auto cost = count_one(setting, named, folder);
      if (!cost) return tl::unexpected(cost.error());
      all.mean_minstr += cost->mean_minstr / kFolders.size();
      all.worst_minstr = std::max(all.worst_minstr, cost->worst_minstr);
    }
    const std::size_t images = kFolders.size() * (named.options.empty() ? kImages : kPeerImages);
    const std::string row = fmt::format("cost at 640x480 / {}", named.name);
    report.rows.push_back(plain_row(row, "mean", "Minstr", all.mean_minstr, images));
    report.rows.push_back(plain_row(row, "worst", "Minstr", all.worst_minstr, images, Join::kMax));
  }
  return {};
}

}  // namespace cgsr::lab
