// 3.3.2: 21 frames a second on 1 GHz with 8x8x8 bins and 27 lights. Here: instructions per image at 640x480.

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/counting.h"
#include "tools/lab/experiment.h"
#include "tools/lab/film.h"

namespace cgsr::lab {
namespace {

constexpr int kGenerated = 2;
constexpr double kDissertation = 1000.0 / 21.0;  // Minstr per image, had every cycle of the 1 GHz been an instruction

/// A film to search in and, where it is another one, the film whose object is sought.
struct Case {
  std::string name;
  std::filesystem::path film;
  std::filesystem::path learn_from;
};

/// A folder that is gone when its owner is.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / fmt::format("cgsr-search-cost-{}", getpid())) {}
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The object of one film sought in the other is an object that is absent.
std::vector<Case> recorded_cases(const std::filesystem::path& data) {
  const auto coke = data / "tracking/coke", dragonbaby = data / "tracking/dragonbaby";
  return {{"coke, object present", coke, coke},
          {"coke, object absent", coke, dragonbaby},
          {"dragonbaby, object present", dragonbaby, dragonbaby},
          {"dragonbaby, object absent", dragonbaby, coke}};
}

/// Films are drawn before they are counted: drawing under callgrind would take an hour.
Result<std::vector<Case>> generated_cases(const Setting& setting, int images, const std::filesystem::path& scratch) {
  std::vector<Case> all;
  for (int i = 0; i < kGenerated; ++i) {
    for (bool absent : {false, true}) {
      const std::string name = fmt::format("generated {}, object {}", i + 1, absent ? "absent" : "present");
      setting.progress(name + ", drawing");
      const Film film = generated_film(setting.seed + static_cast<std::uint64_t>(i), images, absent);
      if (auto saved = save_film(film, scratch / film.name); !saved) return tl::unexpected(saved.error());
      all.push_back({name, scratch / film.name, scratch / film.name});
    }
  }
  return all;
}

/// Labels and search are Alg. 3.2, what the dissertation's figure stands for; worst case by worst case, which no image exceeds.
Cost labels_and_search(const Counted& counted) {
  Cost sum;
  for (const char* stage : {"labels", "search"}) {
    const auto cost = counted.stages.find(stage);
    if (cost == counted.stages.end()) continue;
    sum.mean_minstr += cost->second.mean_minstr;
    sum.worst_minstr += cost->second.worst_minstr;
  }
  return sum;
}

/// Means over all images, the worst of all.
struct Total {
  Cost cost;
  int images = 0;

  void add(const Cost& other, int other_images) {
    cost.mean_minstr = (cost.mean_minstr * images + other.mean_minstr * other_images) / (images + other_images);
    cost.worst_minstr = std::max(cost.worst_minstr, other.worst_minstr);
    images += other_images;
  }
};

void add_rows(const std::string& row, const std::string& what, const Total& total, std::optional<double> dissertation,
              Report& report) {
  report.rows.push_back({row, what, "Minstr", dissertation, total.cost.mean_minstr, std::nullopt, total.images});
  report.rows.push_back(plain_row(row, what + ", worst", "Minstr", total.cost.worst_minstr,
                                  static_cast<std::size_t>(total.images), Join::kMax));
}

}  // namespace

Result<Report> search_cost(const Setting& setting) {
  Report report{"search-cost",
                "instructions per image at 640x480 YUYV: every window of every size, the whole image searched",
                "",
                setting.seed,
                {},
                {},
                {}};
  const int images = setting.trials + 1;
  const Scratch scratch;
  auto all = generated_cases(setting, images, scratch.path());
  if (!all) return tl::unexpected(all.error());
  if (setting.data) {
    const auto recorded = recorded_cases(*setting.data);
    all->insert(all->begin(), recorded.begin(), recorded.end());
  }
  Total search, everything;
  for (const Case& one : *all) {
    setting.progress(one.name + ", counting");
    const auto counted = count_follow("ours", setting.config_file,
                                      {"--size", "640x480", "--images", std::to_string(images), "--input",
                                       one.film.string(), "--learn-from", one.learn_from.string()});
    if (!counted) return tl::unexpected(counted.error());
    const Cost both = labels_and_search(*counted);
    search.add(both, counted->images);
    everything.add(counted->image, counted->images);
    for (const auto& [stage, cost] : counted->stages) {
      report.rows.push_back({one.name, stage, "Minstr", std::nullopt, cost.mean_minstr, std::nullopt, counted->images});
    }
    add_rows(one.name, "labels and search", {both, counted->images}, std::nullopt, report);
    add_rows(one.name, "everything", {counted->image, counted->images}, std::nullopt, report);
  }
  add_rows("all", "labels and search", search, kDissertation, report);
  add_rows("all", "everything", everything, std::nullopt, report);
  report.notes = {
      "The dissertation's figure is 21 frames/s on 1 GHz: 47.6 million instructions an image, if each took one cycle.",
      "SSE2 baseline, counted by tools/count; repeats exactly. The worst of labels and search is the sum of their "
      "worsts.",
      "Everything is the whole tracker: labels, search, and the choice and fit of the box."};
  if (!setting.data) report.notes.emplace_back("Without CGSR_DATA the recorded sequences are left out.");
  return report;
}

}  // namespace cgsr::lab
