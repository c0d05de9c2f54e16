#include "tools/lab/store.h"

#include <fstream>
#include <iterator>
#include <random>

#include <fmt/format.h>

#include "tools/lab/source_path.h"
#include "tools/lab/sources.h"

namespace cgsr::lab {

namespace {
constexpr std::uint64_t kMaxDrawnSeed = 999'999'999;  // a seed fits into every generator of the simulator
}

std::uint64_t draw_seed() {
  std::random_device device;
  return std::uniform_int_distribution<std::uint64_t>(kMinDrawnSeed, kMaxDrawnSeed)(device);
}

Result<std::optional<Report>> Store::read(std::string_view name) const {
  const auto file = file_of(name);
  std::ifstream in(file);
  if (!in) return std::nullopt;
  const auto reports = reports_of(std::string(std::istreambuf_iterator<char>(in), {}));
  if (!reports) return fail(fmt::format("{}: {}", file.string(), reports.error().message));
  if (reports->size() != 1 || reports->front().name != name) {
    return fail(fmt::format("{}: expected one table, '{}'", file.string(), name));
  }
  return reports->front();
}

Result<void> Store::write(const Report& report) const {
  for (const Run& run : report.runs) {
    if (run.seed < kMinDrawnSeed) {
      return fail(
          fmt::format("{}: seed {} is one for tuning and tests; published results need one that was drawn, at "
                      "least {}: leave out --seed",
                      report.name, run.seed, kMinDrawnSeed));
    }
  }
  std::filesystem::create_directories(folder_);
  const auto file = file_of(report.name);
  std::ofstream out(file);
  out << to_json_text({report});
  if (!out.flush()) return fail(fmt::format("{}: cannot be written", file.string()));
  return {};
}

std::string_view to_string(Staleness staleness) {
  switch (staleness) {
    case Staleness::kFresh:
      return "fresh";
    case Staleness::kConfiguration:
      return "configuration changed";
    case Staleness::kSources:
      return "sources changed";
  }
  return "";
}

Result<Staleness> staleness_of(const Report& stored, const Experiment& experiment) {
  const auto configuration = experiment.config_sha256(Setting{});
  if (!configuration) return tl::unexpected(configuration.error());
  if (stored.config_sha256 != *configuration) return Staleness::kConfiguration;
  const auto sources = sources_sha256(source_path(""), experiment.sources());
  if (!sources) return tl::unexpected(sources.error());
  return stored.sources_sha256 == *sources ? Staleness::kFresh : Staleness::kSources;
}

}  // namespace cgsr::lab
