// How reliable the log-odds of an error are that the gate states of a searched pose: in drawn homes, with right and wrong maps, free and
// obstructed views, priors of several widths. And the weights that these poses would give it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/generator/home.h"
#include "tools/lab/drawn_home.h"
#include "tools/lab/experiment.h"
#include "tools/lab/localization/disturbance.h"
#include "tools/lab/localization/odds_fit.h"
#include "tools/lab/localization/trial.h"

namespace cgsr::lab {
namespace {

constexpr int kPerHome = 20;
constexpr int kFolds = 5;
constexpr std::uint64_t kHomes = 0x6A7E;
constexpr double kFromWall_m = 0.4;
constexpr double kFalse_m = 0.05;
constexpr double kFalse_rad = 1.5 * std::numbers::pi / 180.0;
constexpr double kNoLimit = 1000.0;                                      // of log-odds
constexpr double kRare = 0.01;                                           // "of what claims .99, .99 is right"
constexpr std::array kBins{0.0, 0.003, 0.01, 0.03, 0.1, 0.3, 0.6, 1.0};  // of the stated probability of an error

enum class Kind { kRight, kPerfect, kObstructed, kWrongMap, kBare };
/// Of a home's poses.
constexpr std::array kKinds{Kind::kRight,      Kind::kObstructed, Kind::kRight, Kind::kWrongMap,   Kind::kPerfect,
                            Kind::kRight,      Kind::kBare,       Kind::kRight, Kind::kWrongMap,   Kind::kRight,
                            Kind::kObstructed, Kind::kRight,      Kind::kRight, Kind::kObstructed, Kind::kWrongMap,
                            Kind::kRight,      Kind::kPerfect,    Kind::kRight, Kind::kObstructed, Kind::kRight};
constexpr std::array kScales{1.0, 1.0, 3.0, 1.0, 2.0, 1.0, 5.0};  // of the prior

/// What came of one pose: a sample, or why there is none.
struct Searched {
  std::optional<OddsSample> sample;
  std::string why;
};

/// A drawn home, what is measured of it, and the localizer with it.
class Home {
 public:
  Home(std::uint32_t seed, int number, const config::Localization& configuration)
      : seed_(seed), number_(number), configuration_(configuration) {}

  Result<void> open(std::uint32_t other_seed) {
    auto home = sim::generate_home(seed_);
    if (!home) return tl::unexpected(home.error());
    home_ = std::move(*home);
    auto place = Place::make(home_.world, home_.world.name);
    if (!place) return tl::unexpected(place.error());
    place_ = std::move(*place);
    edges_ = std::make_unique<TrueEdges>(place_->scene());
    auto copy = survey(*place_, sim::CalibrationErrors::chapter_4(), seed_);
    if (!copy) return tl::unexpected(copy.error());
    copy_ = std::move(*copy);
    auto perfect = survey(*place_, sim::CalibrationErrors::none(), 0);
    if (!perfect) return tl::unexpected(perfect.error());
    perfect_ = std::move(*perfect);
    const auto other = sim::generate_home(other_seed);
    if (!other) return tl::unexpected(other.error());
    auto other_place = Place::make(other->world, other->world.name);
    if (!other_place) return tl::unexpected(other_place.error());
    auto other_map = survey(**other_place, sim::CalibrationErrors::none(), 0);
    if (!other_map) return tl::unexpected(other_map.error());
    other_map_ = std::move(other_map->map);
    return {};
  }

  /// Searches for one pose.
  Result<Searched> search(int pose, Random random) {
    const Kind kind = kKinds.at(static_cast<std::size_t>(pose) % kKinds.size());
    const double scale = kScales.at(static_cast<std::size_t>(number_ * kPerHome + pose) % kScales.size());
    const sim::FloorRect floor = home_.plan.outline.inset(kFromWall_m);
    const View view = kind == Kind::kBare ? View{0, 2} : View{};
    const auto at = draw_standpoint(*place_, *edges_, {floor.x0, floor.x1, floor.y0, floor.y1}, view, random);
    if (!at) return Searched{{}, "no such view"};
    const auto photo = photograph(kind, *at, pose, random);
    if (!photo) return tl::unexpected(photo.error());
    const geometry::Vector6d error = draw_prior_error(scale, random);
    const auto told = survey_for(kind, scale, random);
    if (!told) return tl::unexpected(told.error());
    const auto prior = localization::prior_at(believed(at->X_WC, error, place_->X_RC(), told->X_RC),
                                              configuration_.prior.sigmas().times(scale));
    const Outcome outcome = correct_once(*localize_stage(*told, configuration_), photo->view(), prior, *at, told->X_RC);
    if (!outcome.answer.corrected) return Searched{{}, std::string(localization::to_string(outcome.answer.reason))};
    if (outcome.answer.starts == 0) return Searched{{}, "no search"};
    OddsSample sample;
    sample.terms = odds_terms(outcome.answer, configuration_.localizer.decision);
    sample.wrong = outcome.error.position_m > kFalse_m || outcome.error.direction_rad > kFalse_rad;
    sample.home = static_cast<int>(seed_);
    return Searched{sample, {}};
  }

 private:
  Result<Photograph> photograph(Kind kind, const Standpoint& at, int pose, const Random& random) {
    const auto number = static_cast<std::uint64_t>(number_ * kPerHome + pose);
    if (kind != Kind::kObstructed) return place_->photograph(at.X_WC, seed_, number);
    // What was drawn may stand in a lamp or a wall: then something else is.
    Result<std::unique_ptr<Place>> place = fail("");
    for (std::uint64_t i = 0; i < 10 && !place; ++i) {
      place =
          Place::make(home_.world, home_.world.name, [&](sim::WorldSpec& spec) { obstruct(spec, at, random.fork(i)); });
    }
    if (!place) return tl::unexpected(place.error());
    return (*place)->photograph(at.X_WC, seed_, number);
  }

  Result<Survey> survey_for(Kind kind, double scale, Random& random) const {
    if (kind == Kind::kPerfect) return perfect_;
    if (kind != Kind::kWrongMap) return copy_;
    const int how = random.below(3);
    if (how == 0) return Survey{copy_.camera, copy_.X_RC, other_map_};
    // A displaced map is as good as a prior that is off: only where the prior says otherwise it can be told.
    const bool whole = how == 1 && scale == 1.0;
    return survey(*place_, sim::CalibrationErrors::chapter_4(), seed_,
                  [&](sim::Scene& map) { whole ? displace(map, random.fork(7)) : scatter(map, random.fork(7)); });
  }

  std::uint32_t seed_;
  int number_;
  config::Localization configuration_;
  sim::GeneratedHome home_;
  std::unique_ptr<Place> place_;
  std::unique_ptr<TrueEdges> edges_;
  Survey copy_;
  Survey perfect_;
  world::Map other_map_;
};

double probability(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// What was stated of samples, one figure each.
std::vector<double> stated(const std::vector<OddsSample>& samples, const OddsTerms& weights) {
  std::vector<double> odds;
  odds.reserve(samples.size());
  for (const OddsSample& s : samples) odds.push_back(weights.dot(s.terms));
  return odds;
}

/// Of each home by what the other folds' homes gave.
std::vector<double> stated_by_others(const std::vector<OddsSample>& samples) {
  std::array<OddsTerms, kFolds> weights;
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<OddsSample> others;
    for (const OddsSample& s : samples) {
      if (s.home % kFolds != fold) others.push_back(s);
    }
    weights.at(static_cast<std::size_t>(fold)) = fit_odds(others);
  }
  std::vector<double> odds;
  odds.reserve(samples.size());
  for (const OddsSample& s : samples)
    odds.push_back(weights.at(static_cast<std::size_t>(s.home % kFolds)).dot(s.terms));
  return odds;
}

struct Bin {
  int count = 0;
  int wrong = 0;
  double stated = 0.0;  ///< summed.

  void add(double probability, bool is_wrong) {
    ++count;
    wrong += is_wrong ? 1 : 0;
    stated += probability;
  }
};

void add_bin(const std::string& row, const Bin& bin, Report& report) {
  if (bin.count == 0) return;
  report.rows.push_back(share_row(row, "wrong", bin.wrong, bin.count));
  report.rows.push_back(plain_row(row, "stated", "", bin.stated / bin.count, static_cast<std::size_t>(bin.count)));
}

/// How what was stated compares with what was, by bins of the stated probability.
void add_reliability(const std::string& row, const std::vector<OddsSample>& samples, const std::vector<double>& odds,
                     Report& report, Plot& plot) {
  std::array<Bin, kBins.size() - 1> bins;
  Bin rare;
  double loss = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double p = probability(odds[i]);
    const auto at = std::upper_bound(kBins.begin() + 1, kBins.end() - 1, p) - (kBins.begin() + 1);
    bins.at(static_cast<std::size_t>(at)).add(p, samples[i].wrong);
    if (p <= kRare) rare.add(p, samples[i].wrong);
    loss += std::log1p(std::exp(samples[i].wrong ? -odds[i] : odds[i]));
  }
  Curve curve{row, {}};
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const Bin& bin = bins.at(i);
    add_bin(fmt::format("{}: {} to {} stated", row, kBins.at(i), kBins.at(i + 1)), bin, report);
    if (bin.count == 0) continue;
    curve.points.push_back(
        {bin.stated / bin.count, static_cast<double>(bin.wrong) / bin.count, wilson(bin.wrong, bin.count)});
  }
  plot.curves.push_back(std::move(curve));
  add_bin(fmt::format("{}: at most {} stated", row, kRare), rare, report);
  if (samples.empty()) return;
  report.rows.push_back(plain_row(row, "log loss", "", loss / static_cast<double>(samples.size()), samples.size()));
}

/// What a limit on the log-odds accepts of all poses drawn: a value per home.
void add_claims(const std::string& row, const std::vector<OddsSample>& samples, const std::vector<double>& odds,
                double limit, const std::vector<int>& homes, Report& report) {
  std::map<int, std::pair<double, double>> by_home;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (odds[i] > limit) continue;
    auto& [claimed, wrong] = by_home[samples[i].home];
    claimed += 1.0 / kPerHome;
    wrong += samples[i].wrong ? 1.0 / kPerHome : 0.0;
  }
  std::vector<double> claimed, wrong;
  claimed.reserve(homes.size());
  wrong.reserve(homes.size());
  for (const int home : homes) {
    claimed.push_back(by_home[home].first);
    wrong.push_back(by_home[home].second);
  }
  report.rows.push_back(mean_row(row, "claimed", "", claimed, report.seed));
  report.rows.push_back(mean_row(row, "claimed and wrong", "", wrong, report.seed));
}

/// The configured weights beside those that these poses give.
void add_weights(const std::vector<OddsSample>& samples, const localization::GateParameters& configured,
                 Report& report) {
  const OddsTerms fitted = fit_odds(samples);
  for (std::size_t i = 0; i < kOddsTerms.size(); ++i) {
    const auto term = static_cast<Eigen::Index>(i);
    const std::string name(kOddsTerms.at(i));
    report.rows.push_back(plain_row(name, "as configured", "", odds_weights(configured)[term], samples.size()));
    report.rows.push_back(plain_row(name, "fitted", "", fitted[term], samples.size()));
  }
}

}  // namespace

Result<Report> gate_reliability(const Setting& setting) {
  auto floor = shipped_localization("floor");
  if (!floor) return tl::unexpected(floor.error());
  const auto free = shipped_localization("free");
  if (!free) return tl::unexpected(free.error());
  const localization::GateParameters shipped = floor->localizer.decision;
  floor->localizer.decision.max_error_log_odds = kNoLimit;
  std::vector<OddsSample> samples;
  std::vector<int> homes;
  std::map<std::string, int> left_out;
  for (int number = 0; number < setting.trials; ++number) {
    const std::uint32_t seed = home_seed(setting.seed, kHomes, number);
    homes.push_back(static_cast<int>(seed));
    Home home(seed, number, *floor);
    if (auto opened = home.open(home_seed(setting.seed, kHomes + 1, number)); !opened)
      return tl::unexpected(opened.error());
    const Random random = Random(setting.seed).fork(kHomes + 2);
    for (int pose = 0; pose < kPerHome; ++pose) {
      const auto searched = home.search(pose, random.fork(static_cast<std::uint64_t>(number * kPerHome + pose)));
      if (!searched) return tl::unexpected(searched.error());
      if (searched->sample) {
        samples.push_back(*searched->sample);
      } else {
        ++left_out[searched->why];
      }
    }
    setting.progress(fmt::format("home {} of {}: {} searched poses", number + 1, setting.trials, samples.size()));
  }
  Report report;
  report.seed = setting.seed;
  report.title =
      fmt::format("the gate's stated odds of an error in {} drawn homes, {} poses each", setting.trials, kPerHome);
  Plot plot{"How often a searched pose is wrong", "stated probability of an error", "share of wrong poses", {}};
  const std::vector<double> ours = stated(samples, odds_weights(shipped));
  add_reliability("as configured", samples, ours, report, plot);
  add_claims("as configured", samples, ours, shipped.max_error_log_odds, homes, report);
  add_claims("at the limit of a camera in a hand", samples, ours, free->localizer.decision.max_error_log_odds, homes,
             report);
  add_reliability("fitted to the other homes", samples, stated_by_others(samples), report, plot);
  plot.curves.push_back({"ideal", {{0.0, 0.0, {}}, {1.0, 1.0, {}}}});
  report.plots.push_back(std::move(plot));
  add_weights(samples, shipped, report);
  report.notes = {
      fmt::format("{} poses in each home, as in false-corrections: ten with the right map and at least six edges, two "
                  "with a perfect copy, four with people or furniture in front, three with a wrong map, one with at "
                  "most two edges, and as many priors of 1, 2, 3 and 5 times the stated width as 4 : 1 : 1 : 1.",
                  kPerHome),
      "Wrong: more than 5 cm or 1.5 degrees off; intervals over poses. Claimed: of all poses drawn; intervals over "
      "homes.",
      fmt::format(
          "Fitted to the other homes: a logistic regression on the same terms in {} folds of homes; log loss is "
          "what it is judged by.",
          kFolds)};
  std::string words;
  for (const auto& [why, count] : left_out) words += fmt::format("{}{} {}", words.empty() ? "" : ", ", count, why);
  if (!words.empty()) report.notes.push_back(fmt::format("Poses without stated odds: {}.", words));
  return report;
}

}  // namespace cgsr::lab
