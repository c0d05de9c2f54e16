// 3.3.2: 21 frames a second on 1 GHz with 8x8x8 bins and 27 lights. Here: instructions per image at 640x480.

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"

namespace cgsr::lab {
namespace {

constexpr int kImages = 60;                      // per film, if --trials does not say otherwise
constexpr double kDissertation = 1000.0 / 21.0;  // Minstr per image, had every cycle of the 1 GHz been an instruction

struct Case {
  std::string name;
  std::vector<std::string> film;
};

std::vector<Case> cases(const Setting& setting) {
  std::vector<Case> all;
  const auto film = [&](const char* name) { return (*setting.data / "tracking" / name).string(); };
  if (setting.data) {
    for (const char* name : {"coke", "dragonbaby"}) {
      all.push_back({fmt::format("{}, object present", name), {"--input", film(name)}});
    }
    // The object of one film sought in the other is an object that is absent.
    all.push_back({"coke, object absent", {"--input", film("coke"), "--learn-from", film("dragonbaby")}});
    all.push_back({"dragonbaby, object absent", {"--input", film("dragonbaby"), "--learn-from", film("coke")}});
  }
  for (int i = 0; i < 3; ++i) {
    const std::string seed = std::to_string(setting.seed + static_cast<std::uint64_t>(i));
    all.push_back({fmt::format("generated {}, object present", i + 1), {"--scene", seed}});
    all.push_back({fmt::format("generated {}, object absent", i + 1), {"--scene", seed, "--absent"}});
  }
  return all;
}

void add_rows(const std::string& row, const Cost& cost, int images, std::optional<double> dissertation,
              Report& report) {
  report.rows.push_back({row, "cost", "Minstr", dissertation, cost.mean_minstr, std::nullopt, images});
  report.rows.push_back({row, "worst cost", "Minstr", std::nullopt, cost.worst_minstr, std::nullopt, images});
}

}  // namespace

Result<Report> search_cost(const Setting& setting) {
  Report report{
      "search-cost",
      "instructions per image of labels and search: 640x480 YUYV, every window of every size, the whole image",
      setting.config_sha256(),
      setting.seed,
      {},
      {},
      {}};
  Cost all;
  int images = 0;
  for (const Case& one : cases(setting)) {
    setting.progress(one.name);
    std::vector<std::string> film{"--size", "640x480", "--images",
                                  std::to_string(setting.trials.value_or(kImages) + 1)};
    film.insert(film.end(), one.film.begin(), one.film.end());
    const auto counted = count_follow("ours", setting.config_file, film);
    if (!counted) return tl::unexpected(counted.error());
    for (const auto& [stage, cost] : counted->stages) {
      add_rows(fmt::format("{} / {}", one.name, stage), cost, counted->images, std::nullopt, report);
    }
    add_rows(one.name, counted->image, counted->images, std::nullopt, report);
    all.mean_minstr += counted->image.mean_minstr * counted->images;
    all.worst_minstr = std::max(all.worst_minstr, counted->image.worst_minstr);
    images += counted->images;
  }
  all.mean_minstr /= std::max(images, 1);
  add_rows("all", all, images, kDissertation, report);
  report.notes = {
      "The dissertation's figure is 21 frames/s on 1 GHz: 47.6 million instructions an image, if each took one cycle.",
      "SSE2 baseline, all threads that work for the image, counted by tools/count; repeats exactly."};
  if (!setting.data) report.notes.emplace_back("Without CGSR_DATA the recorded sequences are left out.");
  return report;
}

}  // namespace cgsr::lab
