// Table 4.1 over homes drawn from seeds: how far a corrected pose is from the true one where nothing was tuned, by home.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/generator/home.h"
#include "tools/lab/drawn_home.h"
#include "tools/lab/experiment.h"
#include "tools/lab/localization/trial.h"

namespace cgsr::lab {
namespace {

constexpr int kPerHome = 10;
constexpr std::uint64_t kHomes = 0x40;
constexpr double kFromWall_m = 0.4;
constexpr double kDeg = 180.0 / std::numbers::pi;
constexpr double kNear_cm = 5.0;
constexpr double kNear_deg = 1.0;
constexpr double kFalse_cm = 5.0;
constexpr double kFalse_deg = 1.5;
constexpr std::array kLogOdds{-1e9, -5.0, -3.5, -2.5, -1.5, 0.0, 1e9};  // bins of the reliability
constexpr double kNoLimit = 100.0;                                      // of log-odds

/// One row of figures per contender: a value per home.
struct ByHome {
  std::vector<double> corrected, position_cm, direction_deg, near, wrong;
  std::array<int, kLogOdds.size() - 1> claims{};        ///< by the stated log-odds of an error.
  std::array<int, kLogOdds.size() - 1> wrong_claims{};  ///< of them.
  int homes_with_wrong = 0;
  Tally tally;
};

/// What one contender made of one home.
struct OfHome {
  std::vector<double> position_cm, direction_deg;
  std::vector<std::pair<double, bool>> claims;  ///< log-odds of an error, and whether it is one.
  int near = 0;
  int wrong = 0;

  /// False: more than 5 cm or 1.5 degrees off and claimed, however bad the prior was.
  void add(const Outcome& outcome) {
    if (!outcome.answer.corrected) return;
    const double cm = outcome.error.position_m * 100.0;
    const double deg = outcome.error.direction_rad * kDeg;
    position_cm.push_back(cm);
    direction_deg.push_back(deg);
    near += cm <= kNear_cm && deg <= kNear_deg ? 1 : 0;
    const bool is_wrong = cm > kFalse_cm || deg > kFalse_deg;
    wrong += is_wrong ? 1 : 0;
    if (outcome.answer.starts > 0) claims.emplace_back(static_cast<double>(outcome.answer.error_log_odds), is_wrong);
  }

  void add_to(ByHome& all) const {
    const auto corrected = static_cast<double>(position_cm.size());
    all.corrected.push_back(corrected / kPerHome);
    all.wrong.push_back(static_cast<double>(wrong) / kPerHome);
    all.homes_with_wrong += wrong > 0 ? 1 : 0;
    for (const auto& [log_odds, is_wrong] : claims) {
      const auto bin = static_cast<std::size_t>(std::upper_bound(kLogOdds.begin() + 1, kLogOdds.end() - 1, log_odds) -
                                                (kLogOdds.begin() + 1));
      ++all.claims.at(bin);
      all.wrong_claims.at(bin) += is_wrong ? 1 : 0;
    }
    if (position_cm.empty()) return;
    all.position_cm.push_back(mean(position_cm));
    all.direction_deg.push_back(mean(direction_deg));
    all.near.push_back(near / corrected);
  }
};

/// Homes with their poses, each corrected by all contenders: the same image and the same prior.
class HomesTrials {
 public:
  HomesTrials(const Setting& setting, std::vector<Contender> contenders)
      : setting_(&setting), contenders_(std::move(contenders)), figures_(contenders_.size()) {}

  Result<void> run(int number) {
    const std::uint32_t seed = home_seed(setting_->seed, kHomes, number);
    const auto home = sim::generate_home(seed);
    if (!home) return tl::unexpected(home.error());
    auto place = Place::make(home->world, home->world.name);
    if (!place) return tl::unexpected(place.error());
    const TrueEdges edges((*place)->scene());
    const auto copy = survey(**place, sim::CalibrationErrors::chapter_4(), seed);
    const auto perfect = survey(**place, sim::CalibrationErrors::none(), 0);
    if (!copy) return tl::unexpected(copy.error());
    if (!perfect) return tl::unexpected(perfect.error());
    std::vector<std::unique_ptr<stages::LocalizeStage>> stages;
    for (const Contender& c : contenders_) {
      stages.push_back(localize_stage(c.perfect_copy ? *perfect : *copy, c.configuration));
    }
    std::vector<OfHome> found(contenders_.size());
    const sim::FloorRect floor = home->plan.outline.inset(kFromWall_m);
    for (int pose = 0; pose < kPerHome; ++pose) {
      const auto stream = static_cast<std::uint64_t>(number * kPerHome + pose);
      Random random = Random(setting_->seed).fork(stream);
      const auto at = draw_standpoint(**place, edges, {floor.x0, floor.x1, floor.y0, floor.y1}, {}, random);
      if (!at) return fail(fmt::format("home {}: nowhere are six edges of 20 px to be seen", seed));
      edges_seen_ += at->edges;
      const geometry::Vector6d error = draw_prior_error(1.0, random);
      const Photograph photo = (*place)->photograph(at->X_WC, seed, stream);
      for (std::size_t c = 0; c < contenders_.size(); ++c) {
        const geometry::Pose X_RC = contenders_[c].perfect_copy ? perfect->X_RC : copy->X_RC;
        const auto prior = localization::prior_at(believed(at->X_WC, error, (*place)->X_RC(), X_RC),
                                                  contenders_[c].configuration.prior.sigmas());
        const Outcome outcome = correct_once(*stages[c], photo.view(), prior, *at, X_RC);
        found[c].add(outcome);
        figures_[c].tally.add(outcome);
      }
    }
    for (std::size_t c = 0; c < found.size(); ++c) found[c].add_to(figures_[c]);
    return {};
  }

  [[nodiscard]] const std::vector<Contender>& contenders() const { return contenders_; }
  [[nodiscard]] const ByHome& figures(std::size_t contender) const { return figures_[contender]; }
  [[nodiscard]] int edges_seen() const { return edges_seen_; }

 private:
  const Setting* setting_;
  std::vector<Contender> contenders_;
  std::vector<ByHome> figures_;
  int edges_seen_ = 0;
};

void add_home_rows(const std::string& row, const ByHome& figures, int homes, Report& report) {
  report.rows.push_back(mean_row(row, "corrected", "", figures.corrected, report.seed));
  report.rows.push_back(mean_row(row, "position error", "cm", figures.position_cm, report.seed));
  report.rows.push_back(mean_row(row, "direction error", "deg", figures.direction_deg, report.seed));
  report.rows.push_back(mean_row(row, "within 5 cm and 1 deg", "", figures.near, report.seed));
  report.rows.push_back(mean_row(row, "false claims", "", figures.wrong, report.seed));
  report.rows.push_back(share_row(row, "homes with a false claim", figures.homes_with_wrong, homes));
}

// Of what was claimed at which stated probability of an error how much was one: the reliability of the gate's log-odds.
void add_reliability(const std::string& row, const ByHome& figures, Report& report) {
  const auto probability = [](double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); };
  for (std::size_t i = 0; i + 1 < kLogOdds.size(); ++i) {
    if (figures.claims.at(i) == 0) continue;
    report.rows.push_back(share_row(row,
                                    fmt::format("wrong where {:.3f} to {:.3f} is stated", probability(kLogOdds.at(i)),
                                                probability(kLogOdds.at(i + 1))),
                                    figures.wrong_claims.at(i), figures.claims.at(i)));
  }
}

}  // namespace

Result<Report> homes_4_1(const Setting& setting) {
  const auto floor = shipped_localization("floor");
  if (!floor) return tl::unexpected(floor.error());
  using localization::Method;
  std::vector<Contender> contenders{
      contender("ours", *floor, Method::kGlCorrect), contender("ours, perfect copy", *floor, Method::kGlCorrect),
      plain_em("plain EM", *floor), contender("ours, without a limit on log-odds", *floor, Method::kGlCorrect)};
  contenders[1].perfect_copy = true;
  constexpr std::size_t kWithoutLimit = 3;
  contenders[kWithoutLimit].configuration.localizer.decision.max_error_log_odds = kNoLimit;
  HomesTrials trials(setting, std::move(contenders));
  for (int i = 0; i < setting.trials; ++i) {
    if (auto done = trials.run(i); !done) return tl::unexpected(done.error());
    setting.progress(fmt::format("home {} of {}: {} of {} poses corrected", i + 1, setting.trials,
                                 trials.figures(0).tally.corrected, (i + 1) * kPerHome));
  }
  Report report;
  report.seed = setting.seed;
  report.title = fmt::format("a pose corrected in {} drawn homes, {} poses each", setting.trials, kPerHome);
  for (std::size_t c = 0; c < trials.contenders().size(); ++c) {
    add_home_rows(trials.contenders()[c].name, trials.figures(c), setting.trials, report);
  }
  add_reliability(trials.contenders()[kWithoutLimit].name, trials.figures(kWithoutLimit), report);
  const double poses = std::max(1, setting.trials * kPerHome);
  report.notes = {fmt::format("A trial is a home of its own (`cgsr sim home`) with {} poses; figures are means over "
                              "homes of each home's mean, intervals "
                              "are over homes.",
                              kPerHome),
                  fmt::format("Every pose sees at least six edges of 20 px of what the map holds, {:.0f} in the mean, "
                              "by rays cast in the simulator; what "
                              "lies about is in no map. Its prior is off by N(0, 15 cm) along each axis of the floor, "
                              "4 degrees of heading, 1 of tilt.",
                              trials.edges_seen() / poses)};
  report.notes.emplace_back(
      "Told is a calibrated copy per home: intrinsics off by 0.2 % and 0.5 px, mount by 0.3 degrees about each axis, "
      "map "
      "by 0.5 cm per rigid part. Noise and lens distortion are on.");
  report.notes.emplace_back(
      "False: corrected is claimed and the pose is more than 5 cm or 1.5 degrees off, however bad the prior was. Plain "
      "EM "
      "has no gate.");
  report.notes.emplace_back(
      "Without a limit on log-odds: whatever is stated of an error's probability; 'wrong where' is the share of these "
      "claims that is false, by what is stated of them.");
  for (const std::size_t c : {0U, 1U}) {
    report.notes.push_back(trials.figures(c).tally.refusals(trials.contenders()[c].name));
  }
  return report;
}

}  // namespace cgsr::lab
