// Parts of the tracking benchmark that take long, as tables of their own: they are measured, stored and resumed by themselves.

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/report.h"
#include "tools/lab/statistics.h"
#include "tools/lab/tracking/cost.h"
#include "tools/lab/tracking/options.h"
#include "tools/lab/tracking/relight.h"

namespace cgsr::lab {
namespace {

const Row* row_of(const Report& report, const std::string& name, std::string_view quantity) {
  const auto found =
      std::ranges::find_if(report.rows, [&](const Row& row) { return row.row == name && row.quantity == quantity; });
  return found == report.rows.end() ? nullptr : &*found;
}

/// How much more of the object ours covers than CSRT under the same changing light, sequence by sequence.
std::optional<Row> ours_minus_csrt(const Report& report, LightChange change, std::uint64_t seed) {
  const std::string row = fmt::format("relit, {} / ", to_string(change));
  const Row* const ours = row_of(report, row + "ours", "IoU");
  const Row* const csrt = row_of(report, row + "CSRT", "IoU");
  if (ours == nullptr || csrt == nullptr || ours->samples.size() != csrt->samples.size()) return std::nullopt;
  std::vector<double> gains;
  std::ranges::transform(ours->samples, csrt->samples, std::back_inserter(gains), std::minus<>());
  return sampled_row(row + "ours minus CSRT", "IoU", "", std::move(gains), Join::kPaired, seed);
}

bool is_of_light(const Row& row) {
  return row.row.starts_with("relit, ") || row.row.starts_with("light estimate") || row.row.starts_with("always ");
}

bool is_of_light_note(const std::string& note) {
  return note.starts_with("Relit ") || note.find("intervals: ") != std::string::npos;
}

}  // namespace

Result<Report> tracking_relit(const Setting& setting) {
  Setting relit = setting;
  if (relit.tracking.output == TrackingOptions{}.output) relit.tracking.output = "out/tracking-relit";
  relit.tracking.parts = {std::string(to_string(BenchmarkPart::kRelit))};
  auto report = tracking_benchmark(relit);
  if (!report) return report;
  report->name = "tracking-relit";
  report->title = "recorded sequences in light that changes, beside constant light of the same mean";
  std::erase_if(report->rows, [](const Row& row) { return !is_of_light(row); });
  std::erase_if(report->notes, [](const std::string& note) { return !is_of_light_note(note); });
  report->plots.clear();  // of the one pass
  for (const LightChange change : kLightChanges) {
    if (auto gain = ours_minus_csrt(*report, change, setting.seed)) report->rows.push_back(std::move(*gain));
  }
  return report;
}

Result<Report> tracking_cost(const Setting& setting) {
  Report report{"tracking-cost",
                "instructions per image at 640x480 while an object is followed, six recorded sequences",
                "",
                setting.seed,
                {},
                {},
                {}};
  if (!setting.count) return fail("tracking-cost counts instructions, which needs valgrind and no --no-count");
  if (auto counted = add_cost_rows(setting, report); !counted) return tl::unexpected(counted.error());
  return report;
}

}  // namespace cgsr::lab
