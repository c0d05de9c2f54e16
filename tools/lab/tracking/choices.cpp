#include "tools/lab/tracking/choices.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/output/text_file.h"
#include "tools/lab/scenes/random.h"

namespace cgsr::lab {
namespace {

constexpr double kSame = 0.01;
constexpr int kDraws = 2000;

/// The standard deviation of the mean over sequences when scenes are drawn with replacement: sequences of a scene are not independent.
double bootstrap_error(const std::map<std::string, std::vector<double>>& gains_of_scene, std::uint64_t seed) {
  std::vector<const std::vector<double>*> scenes;
  for (const auto& [scene, gains] : gains_of_scene) scenes.push_back(&gains);
  if (scenes.size() < 2) return 0.0;
  Random random(seed);
  double sum = 0.0, squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    double total = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const auto& gains = *scenes[static_cast<std::size_t>(random.below(static_cast<int>(scenes.size())))];
      for (const double gain : gains) total += gain;
      count += gains.size();
    }
    const double mean = total / static_cast<double>(count);
    sum += mean;
    squares += mean * mean;
  }
  return std::sqrt(std::max(0.0, squares / kDraws - sum / kDraws * (sum / kDraws)));
}

}  // namespace

int Choice::positive_folds() const {
  return static_cast<int>(std::ranges::count_if(fold_gain, [](double of_fold) { return of_fold > 0.0; }));
}

bool Choice::is_kept() const {
  return positive_folds() >= kFolds - 1 && gain > error;
}

Choice compare(const std::map<std::string, double>& before, const std::map<std::string, double>& after,
               const Folds& folds, std::uint64_t seed) {
  Choice choice;
  std::map<std::string, std::vector<double>> gains_of_scene;
  int count = 0;
  for (const auto& [sequence, figure] : after) {
    const auto old = before.find(sequence);
    if (old == before.end()) continue;
    const double gain = figure - old->second;
    const auto fold = static_cast<std::size_t>(folds.of(sequence) - 1);
    choice.fold_gain[fold] += gain;
    ++choice.fold_size[fold];
    choice.gain += gain;
    ++count;
    (gain > kSame ? choice.won : gain < -kSame ? choice.lost : choice.same) += 1;
    gains_of_scene[folds.scene_of(sequence)].push_back(gain);
  }
  for (std::size_t i = 0; i < kFolds; ++i) choice.fold_gain[i] /= std::max(choice.fold_size[i], 1);
  choice.gain /= std::max(count, 1);
  choice.error = bootstrap_error(gains_of_scene, seed);
  return choice;
}

void add_choice_rows(const Figures& before, const Figures& after, const Folds& folds, std::uint64_t seed,
                     Report& report) {
  for (const auto& [name, figures] : after) {
    const auto old = before.find(name);
    if (old == before.end()) continue;
    const Choice choice = compare(old->second, figures, folds, seed);
    const std::string row = fmt::format("gain over the earlier variant, {}", name);
    const auto add = [&](const std::string& quantity, double value, int trials) {
      report.rows.push_back(plain_row(row, quantity, "", value, static_cast<std::size_t>(trials)));
    };
    const int sequences = choice.won + choice.lost + choice.same;
    add("gain", choice.gain, sequences);
    add("bootstrap error", choice.error, sequences);
    for (std::size_t i = 0; i < kFolds; ++i)
      add(fmt::format("fold {}", i + 1), choice.fold_gain[i], choice.fold_size[i]);
    add("won", choice.won, sequences);
    add("lost", choice.lost, sequences);
    add("kept", choice.is_kept() ? 1.0 : 0.0, sequences);
  }
}

Result<void> write_figures(const Figures& figures, const std::filesystem::path& path) {
  return app::write_file(path, nlohmann::json(figures).dump(1) + "\n");
}

Result<Figures> read_figures(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return fail(fmt::format("cannot read {}", path.string()));
  try {
    return nlohmann::json::parse(file).get<Figures>();
  } catch (const nlohmann::json::exception& error) {
    return fail(fmt::format("{}: is not the figures of an earlier run: {}", path.string(), error.what()));
  }
}

}  // namespace cgsr::lab
