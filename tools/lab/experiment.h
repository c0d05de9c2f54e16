#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"
#include "src/config/color.h"
#include "tools/lab/report.h"
#include "tools/lab/tracking/options.h"

namespace cgsr::lab {

/// What a table is measured with.
struct Setting {
  std::uint64_t seed = 1;
  int trials = 0;                             ///< 0: the table's own number, which measure() fills in
  std::optional<std::filesystem::path> data;  ///< the folder of real images, where there is one
  std::optional<std::filesystem::path>
      videos;         ///< where tables that film put their films; nothing: in the folder for temporary files
  bool count = true;  ///< measure instructions as well, which is slow
  config::Color configuration;
  std::string config_file;  ///< where it came from; empty: it is what ships
  std::function<void(const std::string&)> progress = [](const std::string&) {};
  TrackingOptions tracking;  ///< of tracking-benchmark alone
};

/// One table or figure that can be reproduced.
struct Experiment {
  std::string_view name;
  std::string_view title;
  int chapter;        ///< of the dissertation.
  int trials;         ///< of one run; runs of all tables together take an hour at most, more trials come by --resume.
  bool by_name_only;  ///< too slow, or in need of data that not everybody has: run only when asked for.
  bool drawn;         ///< whether its trials depend on the seed: else there is nothing to join.
  Result<Report> (*run)(const Setting&);
  Result<std::string> (*config_sha256)(const Setting&);  ///< of exactly the sections that it measures with.
  std::span<const std::string_view> rooms;  ///< whose sources it measures, and the simulator's that it measures with.
  std::array<std::string_view, 5> own;      ///< its own sources and worlds; empty: none.

  /// \return rooms and own.
  [[nodiscard]] std::vector<std::string_view> sources() const;
};

std::span<const Experiment> experiments();

/// \return the table of this name; nullptr: there is none.
const Experiment* experiment_of(std::string_view name);

/// Runs a table and adds to its report what makes it comparable: requirements, hashes, seed, trials and commit.
Result<Report> measure(const Experiment& experiment, Setting setting);

// One file each in tables/.
Result<Report> real_video(const Setting& setting);
Result<Report> tracking_benchmark(const Setting& setting);
Result<Report> tracking_relit(const Setting& setting);
Result<Report> tracking_cost(const Setting& setting);
Result<Report> light_sweep(const Setting& setting);
Result<Report> search_cost(const Setting& setting);
Result<Report> figure_3_3(const Setting& setting);
Result<Report> table_4_1(const Setting& setting);
Result<Report> homes_4_1(const Setting& setting);
Result<Report> gate_reliability(const Setting& setting);
Result<Report> start_anywhere(const Setting& setting);
Result<Report> table_4_2(const Setting& setting);
Result<Report> real_localization(const Setting& setting);
Result<Report> section_4_3_3(const Setting& setting);
Result<Report> false_corrections(const Setting& setting);
Result<Report> home_round(const Setting& setting);
Result<Report> homes_round(const Setting& setting);
Result<Report> map_refine(const Setting& setting);
Result<Report> closed_loop(const Setting& setting);
Result<Report> figure_6_8(const Setting& setting);
Result<Report> table_5_1(const Setting& setting);
Result<Report> section_5_4_3(const Setting& setting);
Result<Report> shaded_ball(const Setting& setting);
Result<Report> homes_5_4_3(const Setting& setting);
Result<Report> lamps_5_1(const Setting& setting);
Result<Report> homes_5_1(const Setting& setting);
Result<Report> lamp_cases(const Setting& setting);
Result<Report> lamp_drives(const Setting& setting);
Result<Report> section_5_4_2(const Setting& setting);

}  // namespace cgsr::lab
