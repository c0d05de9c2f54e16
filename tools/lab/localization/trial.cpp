#include "tools/lab/localization/trial.h"

#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "platform/count_marks.h"
#include "platform/work_budget.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

constexpr double kDeg = 180.0 / std::numbers::pi;
constexpr int kMostImages = 200;
constexpr double kFalse_m = 0.05;
constexpr double kFalse_rad = 1.5 / kDeg;

}  // namespace

Result<config::Localization> shipped_localization(const std::string& name) {
  return config::load_localization(std::filesystem::path(source_path("config/localization")) / (name + ".toml"));
}

Contender contender(std::string name, const config::Localization& shipped, localization::Method method) {
  Contender made{std::move(name), shipped, false};
  made.configuration.localizer.method = method;
  return made;
}

Contender plain_em(std::string name, const config::Localization& shipped) {
  Contender made{std::move(name), shipped, false};
  made.configuration.localizer.search = false;
  made.configuration.localizer.gate = false;
  return made;
}

PoseError error_of(const geometry::Pose& X, const geometry::Pose& X_true) {
  const geometry::Vector6d step = geometry::step_between(X_true, X);
  return {step.head<3>().norm(), step.tail<3>().norm()};
}

bool Outcome::false_correction() const {
  return answer.corrected && ((error.position_m > prior.position_m && error.position_m > kFalse_m) ||
                              (error.direction_rad > prior.direction_rad && error.direction_rad > kFalse_rad));
}

std::unique_ptr<stages::LocalizeStage> localize_stage(const Survey& measured,
                                                      const config::Localization& configuration) {
  stages::LocalizationSetup setup;
  setup.map = std::make_shared<const world::Map>(measured.map);
  setup.camera = measured.camera;
  setup.X_RC = measured.X_RC;
  setup.localizer = configuration.localizer;
  setup.tracking = configuration.tracker;
  return std::make_unique<stages::LocalizeStage>(std::move(setup));
}

Outcome correct_once(stages::LocalizeStage& stage, const ImageView& image, const localization::Prior& prior,
                     const Standpoint& truth, const geometry::Pose& X_RC_told) {
  stage.restart();
  Outcome outcome;
  UnlimitedBudget budget;
  do {
    count_stage_begin();
    outcome.answer = stage.correct(budget, image, prior);
    count_stage_end("correct");
    count_image_end();
    ++outcome.images;
  } while (outcome.answer.reason == localization::Reason::kSearching && outcome.images < kMostImages);
  outcome.error = error_of(outcome.answer.X_WC, truth.X_WC);
  outcome.robot = error_of(outcome.answer.X_WC * X_RC_told.inverse(), truth.X_WR);
  outcome.prior = error_of(prior.X_WC, truth.X_WC);
  return outcome;
}

void Tally::add(const Outcome& outcome) {
  ++trials;
  wrong += outcome.false_correction() ? 1 : 0;
  if (!outcome.answer.corrected) {
    ++refused[std::string(to_string(outcome.answer.reason))];
    return;
  }
  ++corrected;
  position_cm.push_back(outcome.error.position_m * 100.0);
  direction_deg.push_back(outcome.error.direction_rad * kDeg);
  robot_cm.push_back(outcome.robot.position_m * 100.0);
  robot_deg.push_back(outcome.robot.direction_rad * kDeg);
  images.push_back(outcome.images);
}

std::string Tally::refusals(const std::string& name) const {
  std::string words;
  for (const auto& [reason, count] : refused) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, reason);
  return words.empty() ? fmt::format("{} was corrected in all.", name)
                       : fmt::format("{} was not corrected in {}: {}.", name, trials - corrected, words);
}

void add_rows(const std::string& row, const Tally& tally, std::uint64_t seed, Report& report,
              std::optional<std::pair<double, double>> theirs) {
  report.rows.push_back(share_row(row, "corrected", tally.corrected, tally.trials));
  Row position = mean_row(row, "position error", "cm", tally.position_cm, seed);
  Row direction = mean_row(row, "direction error", "deg", tally.direction_deg, seed);
  if (theirs) {
    position.dissertation = theirs->first;
    direction.dissertation = theirs->second;
  }
  report.rows.push_back(std::move(position));
  report.rows.push_back(std::move(direction));
  report.rows.push_back(mean_row(row, "images needed, no limit on work", "", tally.images, seed));
  report.rows.push_back(share_row(row, "false corrections", tally.wrong, tally.trials));
}

}  // namespace cgsr::lab
