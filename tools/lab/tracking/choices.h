#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "platform/error.h"
#include "tools/lab/report.h"
#include "tools/lab/tracking/folds.h"

namespace cgsr::lab {

/// One figure per sequence, by part of the benchmark and quantity: what a variant of the tracker reached.
using Figures = std::map<std::string, std::map<std::string, double>>;  // "one pass, AUC" -> sequence -> figure

/// Keeps figures as JSON, so that another variant, of code or configuration, can be compared with them.
Result<void> write_figures(const Figures& figures, const std::filesystem::path& path);
/// \return what write_figures() wrote; or what is wrong with the file.
Result<Figures> read_figures(const std::filesystem::path& path);

/// What a change of the tracker brings, over the sequences that both variants have.
struct Choice {
  std::array<double, kFolds> fold_gain{};  ///< mean over the sequences of a fold
  std::array<int, kFolds> fold_size{};
  double gain = 0.0;                ///< mean over sequences
  double error = 0.0;               ///< standard deviation of that mean, by bootstrap over scenes
  int won = 0, lost = 0, same = 0;  ///< sequences whose figure rose or fell by more than .01
  [[nodiscard]] int positive_folds() const;
  /// \return whether the change is kept: the gain is positive in at least four folds and exceeds the bootstrap error.
  [[nodiscard]] bool is_kept() const;
};

Choice compare(const std::map<std::string, double>& before, const std::map<std::string, double>& after,
               const Folds& folds, std::uint64_t seed);

/// Adds the table of choices: a line per figure that both variants have.
void add_choice_rows(const Figures& before, const Figures& after, const Folds& folds, std::uint64_t seed,
                     Report& report);

}  // namespace cgsr::lab
