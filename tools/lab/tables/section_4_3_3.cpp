// Section 4.3.3: nine poses before a wall that two cloth walls hide in part, and the same poses with the cloth walls taken away.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

constexpr std::size_t kContenders = 2;

/// Both worlds with all contenders, and what came of their trials.
class HiddenEdges {
 public:
  static Result<HiddenEdges> make(const Setting& setting) {
    const auto floor = shipped_localization("floor");
    if (!floor) return tl::unexpected(floor.error());
    auto with = Place::make("occlusion");
    if (!with) return tl::unexpected(with.error());
    auto without = Place::make("occlusion", [](sim::WorldSpec& spec) {
      std::erase_if(spec.shape, [](const sim::ShapeSpec& shape) { return is_occluder(shape.name); });
    });
    if (!without) return tl::unexpected(without.error());
    return HiddenEdges(setting, *floor, std::move(*with), std::move(*without));
  }

  /// All poses with the same errors of camera, mount and of all that stands in both.
  Result<void> run(int trial) {
    const auto seed =
        static_cast<std::uint32_t>(Random(setting_->seed).fork(0x433).fork(static_cast<std::uint64_t>(trial)).next());
    const auto errors = sim::CalibrationErrors::chapter_4();
    const auto told = survey(*with_, errors, seed);
    if (!told) return tl::unexpected(told.error());
    const auto told_without = survey(*with_, errors, seed, [](sim::Scene& map) {
      std::erase_if(map.parts, [](const sim::Part& part) { return is_occluder(part.name); });
    });
    if (!told_without) return tl::unexpected(told_without.error());
    for (std::size_t view = 0; view < poses(); ++view) {
      setting_->progress(fmt::format("trial {} of {}, pose {}", trial + 1, setting_->trials, view + 1));
      run_pose(trial, view, *told, *told_without);
    }
    return {};
  }

  [[nodiscard]] std::size_t poses() const { return with_->world().views.size(); }
  [[nodiscard]] const Contender& contender_at(std::size_t c) const { return contenders_[c]; }
  [[nodiscard]] const Paired& result(std::size_t c) const { return results_[c]; }

 private:
  HiddenEdges(const Setting& setting, const config::Localization& floor, std::unique_ptr<Place> with,
              std::unique_ptr<Place> without)
      : setting_(&setting),
        contenders_{contender("ours", floor, localization::Method::kGlCorrect),
                    contender("Stronger, ungated", floor, localization::Method::kStronger)},
        with_(std::move(with)),
        without_(std::move(without)) {}

  void run_pose(int trial, std::size_t view, const Survey& told, const Survey& told_without) {
    const auto number = static_cast<std::uint64_t>(trial) * poses() + view;
    Random random = Random(setting_->seed).fork(0x4330000 + number);
    const geometry::Vector6d error = draw_prior_error(1.0, random);
    const geometry::Pose& X_WC = with_->world().views[view].X_WC;
    const Standpoint at{X_WC * with_->X_RC().inverse(), X_WC, 0};
    const geometry::Pose X_prior = believed(at.X_WC, error, with_->X_RC(), told.X_RC);
    const auto seed = static_cast<std::uint32_t>(setting_->seed);
    const auto photo = with_->photograph(at.X_WC, seed, number);
    const auto photo_without = without_->photograph(at.X_WC, seed, number);
    for (std::size_t c = 0; c < kContenders; ++c) {
      const config::Localization& configuration = contenders_[c].configuration;
      const auto prior = localization::prior_at(X_prior, configuration.prior.sigmas());
      const auto stage = localize_stage(told, configuration);
      const auto stage_without = localize_stage(told_without, configuration);
      add(results_[c], correct_once(*stage, photo.view(), prior, at, told.X_RC),
          correct_once(*stage_without, photo_without.view(), prior, at, told.X_RC));
    }
  }

  static void add(Paired& result, const Outcome& hidden, const Outcome& open) {
    result.with.add(hidden);
    result.without.add(open);
    if (!hidden.answer.corrected || !open.answer.corrected) return;
    result.position_cm.push_back(result.with.position_cm.back() - result.without.position_cm.back());
    result.direction_deg.push_back(result.with.direction_deg.back() - result.without.direction_deg.back());
  }

  const Setting* setting_;
  std::array<Contender, kContenders> contenders_;
  std::array<Paired, kContenders> results_;
  std::unique_ptr<Place> with_;
  std::unique_ptr<Place> without_;
};

void add_rows(const std::string& name, const Paired& result, std::pair<double, double> theirs, Report& report) {
  add_rows(name + ", cloth walls", result.with, report.seed, report, theirs);
  add_rows(name + ", without them", result.without, report.seed, report);
  const std::string row = name + ", what they change";
  const auto add = [&](const char* quantity, const char* unit, const std::vector<double>& differences, Join join) {
    report.rows.push_back(sampled_row(row, quantity, unit, differences, join, report.seed));
  };
  add("position error", "cm", result.position_cm, Join::kPaired);
  add("direction error", "deg", result.direction_deg, Join::kPaired);
  add("p, position", "", result.position_cm, Join::kPairedP);
  add("p, direction", "", result.direction_deg, Join::kPairedP);
}

}  // namespace

Result<Report> section_4_3_3(const Setting& setting) {
  auto trials = HiddenEdges::make(setting);
  if (!trials) return tl::unexpected(trials.error());
  for (int t = 0; t < setting.trials; ++t) {
    if (auto done = trials->run(t); !done) return tl::unexpected(done.error());
  }
  Report report;
  report.seed = setting.seed;
  report.title = fmt::format("{} poses before hidden edges, {} trials each", trials->poses(), setting.trials);
  add_rows(trials->contender_at(0).name, trials->result(0), {7.20, 7.62}, report);
  add_rows(trials->contender_at(1).name, trials->result(1), {62.4, 42.1}, report);
  report.notes = {
      "Paired: pose, prior, calibration and noise of a trial are the same with the cloth walls and without. What they "
      "change "
      "is the mean of the differences where both were corrected, its interval and p are those of Student's paired "
      "t-test.",
      "Priors and calibration are off as in table-4.1; another calibration for every trial. Stronger has no gate."};
  report.notes.push_back(trials->result(0).with.refusals("ours, cloth walls,"));
  report.notes.push_back(trials->result(0).without.refusals("ours, without them,"));
  return report;
}

}  // namespace cgsr::lab
