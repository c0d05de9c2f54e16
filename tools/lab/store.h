#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "platform/error.h"
#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// Figures that are published were measured with seeds from here on; those below are for tuning and for tests.
inline constexpr std::uint64_t kMinDrawnSeed = 1000;

/// \return a seed from the system's source of random numbers, at least kMinDrawnSeed.
std::uint64_t draw_seed();

/// The folder of published results: a JSON file a table, as `cgsr reproduce --json` writes it.
class Store {
 public:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// \return nothing: the table is not in it; or what is wrong with its file.
  [[nodiscard]] Result<std::optional<Report>> read(std::string_view name) const;

  /// Replaces the table.
  /// \return a seed below kMinDrawnSeed is refused, and so is what cannot be written.
  [[nodiscard]] Result<void> write(const Report& report) const;

  [[nodiscard]] std::filesystem::path file_of(std::string_view name) const {
    return folder_ / (std::string(name) + ".json");
  }

 private:
  std::filesystem::path folder_;
};

/// Why a stored table is not what this tree would measure.
enum class Staleness : std::uint8_t { kFresh, kConfiguration, kSources };
/// \return "configuration changed", "sources changed" or "fresh".
std::string_view to_string(Staleness staleness);

/// Compares the hashes of a stored table with those of this tree. \return which of the table's files cannot be read.
Result<Staleness> staleness_of(const Report& stored, const Experiment& experiment);

}  // namespace cgsr::lab
