// Section 4.3.3: nine poses before a wall that two cloth walls hide in part, and the same poses with the cloth walls taken away.

#include <algorithm>
#include <array>
#include <memory>

#include <fmt/format.h>

#include "tools/lab/experiment.h"
#include "tools/lab/localization/trial.h"

namespace cgsr::lab {
namespace {

bool is_occluder(const std::string& name) {
  return name.starts_with("blue ") || name.starts_with("yellow ");
}

/// One contender's trials in both worlds, and what the occluders changed where both were corrected.
struct Paired {
  Tally with, without;
  std::vector<double> position_cm, direction_deg;
};

}  // namespace

Result<Report> section_4_3_3(const Setting& setting) {
  const auto floor = shipped_localization("floor");
  if (!floor) return tl::unexpected(floor.error());
  const std::array contenders{contender("ours", *floor, localization::Method::kGlCorrect),
                              contender("Stronger, ungated", *floor, localization::Method::kStronger)};
  std::array<Paired, contenders.size()> results;

  auto with = Place::make("occlusion");
  if (!with) return tl::unexpected(with.error());
  auto without = Place::make("occlusion", [](sim::WorldSpec& spec) {
    std::erase_if(spec.shape, [](const sim::ShapeSpec& shape) { return is_occluder(shape.name); });
  });
  if (!without) return tl::unexpected(without.error());
  const auto& views = (*with)->world().views;

  const int trials = setting.trials;
  for (int t = 0; t < trials; ++t) {
    // The same errors of camera, mount and of all that stands in both.
    const auto seed =
        static_cast<std::uint32_t>(Random(setting.seed).fork(0x433).fork(static_cast<std::uint64_t>(t)).next());
    const auto errors = sim::CalibrationErrors::chapter_4();
    const auto told = survey(**with, errors, seed);
    if (!told) return tl::unexpected(told.error());
    const auto told_without = survey(**with, errors, seed, [](sim::Scene& map) {
      std::erase_if(map.parts, [](const sim::Part& part) { return is_occluder(part.name); });
    });
    if (!told_without) return tl::unexpected(told_without.error());
    for (std::size_t v = 0; v < views.size(); ++v) {
      setting.progress(fmt::format("trial {} of {}, pose {}", t + 1, trials, v + 1));
      const auto number = static_cast<std::uint64_t>(t) * views.size() + v;
      Random random = Random(setting.seed).fork(0x4330000 + number);
      const geometry::Vector6d error = draw_prior_error(1.0, random);
      const Standpoint at{views[v].X_WC * (*with)->X_RC().inverse(), views[v].X_WC, 0};
      const geometry::Pose X_prior = believed(at.X_WC, error, (*with)->X_RC(), told->X_RC);
      const auto photo = (*with)->photograph(at.X_WC, static_cast<std::uint32_t>(setting.seed), number);
      const auto photo_without = (*without)->photograph(at.X_WC, static_cast<std::uint32_t>(setting.seed), number);
      for (std::size_t c = 0; c < contenders.size(); ++c) {
        const auto prior = localization::prior_at(X_prior, contenders[c].configuration.prior.sigmas());
        localization::Localizer localizer(told->map, told->camera, contenders[c].configuration.localizer);
        localization::Localizer localizer_without(told_without->map, told_without->camera,
                                                  contenders[c].configuration.localizer);
        const Outcome hidden = correct_once(localizer, photo.view(), prior, at, told->X_RC);
        const Outcome open = correct_once(localizer_without, photo_without.view(), prior, at, told->X_RC);
        Paired& result = results[c];
        result.with.add(hidden);
        result.without.add(open);
        if (!hidden.answer.corrected || !open.answer.corrected) continue;
        result.position_cm.push_back(result.with.position_cm.back() - result.without.position_cm.back());
        result.direction_deg.push_back(result.with.direction_deg.back() - result.without.direction_deg.back());
      }
    }
  }

  Report report;
  report.title = fmt::format("{} poses before hidden edges, {} trials each", views.size(), trials);
  for (std::size_t c = 0; c < contenders.size(); ++c) {
    const std::string& name = contenders[c].name;
    const std::pair<double, double> theirs = c == 0 ? std::pair(7.20, 7.62) : std::pair(62.4, 42.1);
    add_rows(name + ", cloth walls", results[c].with, setting.seed, report, theirs);
    add_rows(name + ", without them", results[c].without, setting.seed, report);
    const std::string row = name + ", what they change";
    const auto add = [&](const char* quantity, const char* unit, const std::vector<double>& differences, Join join) {
      report.rows.push_back(sampled_row(row, quantity, unit, differences, join, setting.seed));
    };
    add("position error", "cm", results[c].position_cm, Join::kPaired);
    add("direction error", "deg", results[c].direction_deg, Join::kPaired);
    add("p, position", "", results[c].position_cm, Join::kPairedP);
    add("p, direction", "", results[c].direction_deg, Join::kPairedP);
  }
  report.notes = {
      "Paired: pose, prior, calibration and noise of a trial are the same with the cloth walls and without. What they "
      "change "
      "is the mean of the differences where both were corrected, its interval and p are those of Student's paired "
      "t-test.",
      "Priors and calibration are off as in table-4.1; another calibration for every trial. Stronger has no gate."};
  report.notes.push_back(results[0].with.refusals("ours, cloth walls,"));
  report.notes.push_back(results[0].without.refusals("ours, without them,"));
  return report;
}

}  // namespace cgsr::lab
