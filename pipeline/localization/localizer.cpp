#include "pipeline/localization/localizer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/alternative_hypothesis.h"
#include "pipeline/localization/expected.h"
#include "pipeline/localization/gate.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/localization/search.h"
#include "pipeline/render/depth_raster.h"

namespace cgsr::localization {
namespace {

constexpr double kReachOfPrior = 2.5;  // sigmas of the prior that matching reaches from the prediction

// Beside the prior's middle where its sigma moves the image more than a pose does that is followed: still one image's work.
constexpr double kOneStart_px = 3.5;
constexpr std::uint32_t kNearStarts = 8;
constexpr double kNearSpread_px = 1.0;       // an axis of the prior that moves the image less needs no starts
constexpr double kNearest = 1.8;             // sigmas
constexpr double kNearAlternative_px = 4.0;  // a pose that is further off and as good leaves the answer open
constexpr float kNearRadius = 0.6F;          // of the first start's

// Shorter pieces are not matched (expected.cpp); a little of them may be longer from the pose that is found.
constexpr double kLeastPiece_px = 5.0;
// Near ones that hide what is behind them: a budget of about 4 million instructions where a map fills the view with things.
constexpr int kMostSurfaces = 1000;

std::unique_ptr<render::Expectation> usual(const world::Map& map, const LocalizerParameters& parameters) {
  if (parameters.method == Method::kStronger) return std::make_unique<EveryEdge>(map);
  render::RasterParameters raster;
  raster.min_piece_px = kLeastPiece_px;
  raster.max_surfaces = kMostSurfaces;
  raster.max_edges = parameters.max_pieces;
  return std::make_unique<render::DepthRaster>(map, raster);
}

// Stronger's method works with all that it projects.
LocalizerParameters fitted(LocalizerParameters parameters, const world::Map& map) {
  if (parameters.method == Method::kStronger)
    parameters.max_pieces = std::max(parameters.max_pieces, static_cast<int>(map.edges.size()));
  if (parameters.method != Method::kGlCorrect) {
    parameters.search = false;
    parameters.gate = false;
  }
  return parameters;
}

}  // namespace

struct Localizer::State {
  State(const world::Map& given_map, const geometry::Camera& camera, const LocalizerParameters& given,
        std::unique_ptr<render::Expectation> given_expectation)
      : map(&given_map),
        parameters(fitted(given, given_map)),
        perception(camera),
        expectation(given_expectation ? std::move(given_expectation) : usual(given_map, parameters)),
        alternation(given_map, parameters, *expectation, perception.camera(), Perception::kMostSegments),
        search(parameters, alternation, perception.camera()),
        alternative(parameters, alternation) {}

  /// \return nothing when the budget did not hold all the starts: without them nobody knows of a alternative hypothesis.
  std::optional<Correction> from_near_starts(const Belief& belief, const PriorShape& shape, WorkBudget& budget);
  [[nodiscard]] Estimate settled(const Estimate& estimate, const Belief& belief);
  /// \param standing  none: the pose was followed, not searched for.
  void judge(const Estimate& estimate, const std::optional<Standing>& standing, Correction& answer) const;

  const world::Map* map;
  LocalizerParameters parameters;
  Perception perception;
  std::unique_ptr<render::Expectation> expectation;
  Alternation alternation;
  Search search;
  AlternativeHypothesis alternative;
};

Localizer::Localizer(const world::Map& map, const geometry::Camera& camera, const LocalizerParameters& parameters,
                     std::unique_ptr<render::Expectation> expectation)
    : state_(std::make_unique<State>(map, camera, parameters, std::move(expectation))) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::carried(const geometry::Pose& X_C0C1) {
  state_->search.carried(X_C0C1);
  state_->alternative.carried(X_C0C1);
}

geometry::Matrix6d Localizer::in_world(const geometry::Matrix6d& covariance) const {
  return with_map_error(covariance, state_->parameters);
}

void Localizer::restart() {
  state_->search.stop();
  state_->alternative.forget();
}

bool Localizer::searching() const {
  return state_->search.running();
}

void Localizer::State::judge(const Estimate& estimate, const std::optional<Standing>& standing,
                             Correction& answer) const {
  const geometry::Matrix6d covariance = covariance_in_map(estimate);
  answer.matches = estimate.matches;
  answer.expected = estimate.expected;
  answer.explained = estimate.explained;
  answer.prior_chi2 = estimate.prior_chi2;
  answer.lead = standing ? standing->lead : 1.0F;
  answer.rms_px = static_cast<float>(estimate.solution.rms_px);
  answer.evidence = standing ? evidence_of(estimate, *standing) : estimate.explained;
  if (parameters.gate) {
    answer.reason = gate(estimate, standing, with_map_error(covariance, parameters), parameters);
  } else if (estimate.solved) {
    answer.reason = Reason::kNone;
  } else {
    answer.reason = estimate.expected == 0 ? Reason::kNothingExpected : Reason::kTooFewMatches;
  }
  answer.corrected = answer.reason == Reason::kNone;
  if (!answer.corrected) return;
  answer.X_WC = estimate.solution.X_WC;
  answer.covariance = covariance;
}

// With the noise that the matches show: a wide prior must not pull a pose off what is seen well.
Estimate Localizer::State::settled(const Estimate& estimate, const Belief& belief) {
  if (!estimate.solved || parameters.method != Method::kGlCorrect) return estimate;
  AlternateOptions options;
  options.rounds = 1;
  options.radius_px = static_cast<float>(parameters.min_match_radius_px);
  options.measured_noise = true;
  options.by_part = true;
  UnlimitedBudget whole;
  const Estimate better = alternation.refine(estimate.solution.X_WC, belief, perception.edges(), options, whole);
  return better.solved ? better : estimate;
}

std::optional<Correction> Localizer::State::from_near_starts(const Belief& belief, const PriorShape& shape,
                                                             WorkBudget& budget) {
  Correction answer;
  AlternateOptions options;
  options.rounds = parameters.max_iterations;
  options.radius_px = static_cast<float>(std::clamp(kReachOfPrior * shape.widest_px() + 2.0,
                                                    parameters.min_match_radius_px, parameters.max_match_radius_px));
  options.look_first = false;  // drawn already, for the prior's width
  const bool narrow = shape.widest_px() <= kOneStart_px;
  options.by_part = parameters.search && !narrow;
  if (narrow && parameters.method == Method::kGlCorrect) options.robust = kFollowedRobust;
  Estimate best = alternation.refine(belief.prior.X_WC, belief, perception.edges(), options, budget);
  if (best.rounds == 0) {
    answer.reason = Reason::kNoBudget;
    return answer;
  }
  if (!parameters.search || narrow) {
    if (parameters.search && best.solved) best = alternative.better_than(best, belief, perception.edges(), budget);
    judge(best, std::nullopt, answer);
    return answer;
  }
  alternative.forget();
  const geometry::Matrix6d metric = alternation.motion_metric(belief.prior.X_WC);
  const auto rank = [](const Estimate& estimate) {
    return estimate.solved ? evidence_of(estimate, Standing{}) : -10.0F;
  };
  std::array<Estimate, kNearStarts + 1> found;
  found[0] = best;
  options.look_first = true;
  options.radius_px *= kNearRadius;
  for (std::uint32_t start = 1; start <= kNearStarts; ++start) {
    geometry::Vector6d step = geometry::Vector6d::Zero();
    for (int i = 0; i < 6; ++i) {
      if (shape.motion_px[i] >= kNearSpread_px)
        step += std::clamp(even_normal(start, i), -kNearest, kNearest) * shape.axes.col(i);
    }
    found[start] =
        alternation.refine(geometry::moved(belief.prior.X_WC, step), belief, perception.edges(), options, budget);
    if (found[start].rounds == 0) return std::nullopt;
    if (rank(found[start]) > rank(best)) best = found[start];
  }
  float lead = 1.0F;
  for (const Estimate& other : found) {
    if (!other.solved) continue;
    const geometry::Vector6d step = geometry::step_between(best.solution.X_WC, other.solution.X_WC);
    if (step.dot(metric * step) > kNearAlternative_px * kNearAlternative_px &&
        !same_answer(best.solution.X_WC, other.solution.X_WC))
      lead = std::min(lead, rank(best) - rank(other));
  }
  judge(settled(best, belief), Standing{.lead = lead, .narrow = true}, answer);
  return answer;
}

Correction Localizer::correct(const ImageView& image, const Prior& prior, WorkBudget& budget,
                              const std::uint8_t* mask) {
  State& s = *state_;
  Correction answer;
  const auto refused = [&](Reason reason) {
    answer = Correction{};
    answer.reason = reason;
    answer.X_WC = prior.X_WC;
    answer.covariance = prior.covariance;
    answer.segments = static_cast<int>(s.perception.edges().size());
    answer.looks = s.alternation.looks();
    return answer;
  };
  s.alternation.reset_looks();
  if (s.map->edges.empty()) return refused(Reason::kNoMap);
  const Reason seen = s.perception.perceive(image, mask);
  if (seen != Reason::kNone) return refused(seen);
  const Belief belief(prior);
  if (!belief.valid) return refused(Reason::kBadPrior);

  if (!s.search.running()) {
    if (!budget.grant()) return refused(Reason::kNoBudget);
    s.alternation.look_if_far(prior.X_WC);
    const PriorShape shape = PriorShape::of(prior.covariance, s.alternation.motion_metric(prior.X_WC));
    std::optional<Correction> at_once;
    if (!s.parameters.search || shape.widest_px() <= s.parameters.max_tracking_sigma_px)
      at_once = s.from_near_starts(belief, shape, budget);
    if (at_once) {
      answer = *at_once;
    } else {
      s.alternative.forget();
      s.search.begin(belief);
    }
  }
  if (s.search.running()) {
    if (s.search.go_on(belief, s.perception.edges(), budget)) {
      s.judge(s.settled(s.search.best(), belief), Standing{.lead = s.search.lead(), .cells = s.search.cells()}, answer);
    } else {
      answer.reason = Reason::kSearching;
    }
    answer.starts = s.search.starts();
  }
  if (!answer.corrected) {
    answer.X_WC = prior.X_WC;
    answer.covariance = prior.covariance;
  }
  answer.segments = static_cast<int>(s.perception.edges().size());
  answer.looks = s.alternation.looks();
  return answer;
}

}  // namespace cgsr::localization
