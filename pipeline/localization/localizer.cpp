#include "pipeline/localization/localizer.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/alternative_hypothesis.h"
#include "pipeline/localization/expected.h"
#include "pipeline/localization/gate.h"
#include "pipeline/localization/near_starts.h"
#include "pipeline/localization/perceive.h"
#include "pipeline/localization/search.h"
#include "pipeline/localization/work.h"
#include "pipeline/render/depth_raster.h"

namespace cgsr::localization {
namespace {

constexpr double kReachOfPrior = 2.5;  // sigmas of the prior that matching reaches from the prediction

// Several starts where the prior's sigma moves the image more than a pose does that is followed.
constexpr double kOneStart_px = 3.5;

// Shorter pieces are not matched (expected.cpp); a little of them may be longer from the pose that is found.
constexpr double kLeastPiece_px = 5.0;
// Near ones that hide what is behind them: a budget of about 4 million instructions where a map fills the view with things.
constexpr int kMostSurfaces = 1000;

// A model is measured as well as it is small.
constexpr double kMapSigmaOfSize = 0.001;

std::unique_ptr<render::Expectation> usual(const world::Map& map, const LocalizerParameters& parameters) {
  if (parameters.method == Method::kStronger) return std::make_unique<EveryEdge>(map);
  render::RasterParameters raster;
  raster.min_piece_px = kLeastPiece_px;
  raster.max_surfaces = kMostSurfaces;
  raster.max_edges = parameters.max_pieces;
  return std::make_unique<render::DepthRaster>(map, raster);
}

double size_m(const world::Map& map) {
  Eigen::AlignedBox3f bounds;
  for (const Eigen::Vector3f& vertex : map.vertices) bounds.extend(vertex);
  return bounds.isEmpty() ? 0.0 : static_cast<double>(bounds.diagonal().norm());
}

// To the map and the method.
LocalizerParameters fitted(LocalizerParameters parameters, const world::Map& map) {
  parameters.map_sigma_m = std::min(parameters.map_sigma_m, kMapSigmaOfSize * size_m(map));
  if (parameters.method == Method::kStronger)  // works with all that it projects
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
        near(parameters.decision, alternation),
        search(parameters, alternation, perception.camera()),
        alternative(parameters, alternation) {}

  /// Begins with a prior: looks at the map from its mean, and chooses how many starts it needs.
  /// \return false when the budget does not hold the look.
  bool begin(const Belief& belief, WorkBudget& budget);
  /// From the prior's mean alone: one image's work.
  Correction follow(const Belief& belief, WorkBudget& budget);
  /// Goes on with what is under way. \return kSearching while it is.
  Correction go_on(const Belief& belief, WorkBudget& budget);
  [[nodiscard]] AlternateOptions options_of(const PriorShape& shape) const;
  [[nodiscard]] bool searching() const { return near.running() || search.running(); }

  [[nodiscard]] Estimate settled(const Estimate& estimate, const Belief& belief);
  /// \param standing  none: the pose was followed, not searched for.
  void judge(const Estimate& estimate, const std::optional<Standing>& standing, Correction& answer) const;

  const world::Map* map;
  LocalizerParameters parameters;
  Perception perception;
  std::unique_ptr<render::Expectation> expectation;
  Alternation alternation;
  NearStarts near;
  Search search;
  AlternativeHypothesis alternative;
  AlternateOptions followed;  ///< how a pose is followed from the prior that begin() saw.
};

Localizer::Localizer(const world::Map& map, const geometry::Camera& camera, const LocalizerParameters& parameters,
                     std::unique_ptr<render::Expectation> expectation)
    : state_(std::make_unique<State>(map, camera, parameters, std::move(expectation))) {}
Localizer::~Localizer() = default;
Localizer::Localizer(Localizer&&) noexcept = default;
Localizer& Localizer::operator=(Localizer&&) noexcept = default;

void Localizer::carried(const geometry::Pose& X_C0C1) {
  state_->near.carried(X_C0C1);
  state_->search.carried(X_C0C1);
  state_->alternative.carried(X_C0C1);
}

geometry::Matrix6d Localizer::in_world(const geometry::Matrix6d& covariance) const {
  return with_map_error(covariance, state_->parameters);
}

void Localizer::restart() {
  state_->near.stop();
  state_->search.stop();
  state_->alternative.forget();
}

bool Localizer::searching() const {
  return state_->searching();
}

const geometry::Camera& Localizer::camera() const {
  return state_->perception.camera();
}

std::span<const LineDistance> Localizer::distances_from(const geometry::Pose& X_WC, const SegmentTable& perceived,
                                                        float radius_px) {
  return state_->alternation.distances_from(X_WC, perceived, radius_px);
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
  answer.cells = standing ? standing->cells : 1.0;
  answer.agreement = estimate.agreement_on_map;
  answer.cost = estimate.solution.cost;
  if (standing && !standing->narrow && estimate.solved)
    answer.error_log_odds = static_cast<float>(log_odds_of_error(estimate, *standing, parameters.decision));
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

// With the noise that the matches show: a wide prior must not pull a pose off what is seen well. In this image alone: the best start may have been
// refined in an earlier one.
Estimate Localizer::State::settled(const Estimate& estimate, const Belief& belief) {
  if (!estimate.solved || parameters.method != Method::kGlCorrect) return estimate;
  AlternateOptions options;
  options.rounds = 1;
  options.radius_px = static_cast<float>(parameters.min_match_radius_px);
  options.measured_noise = true;
  options.by_part = true;
  UnlimitedBudget whole;
  return alternation.refine(estimate.solution.X_WC, belief, perception.edges(), options, whole);
}

AlternateOptions Localizer::State::options_of(const PriorShape& shape) const {
  AlternateOptions options;
  options.rounds = parameters.max_iterations;
  options.radius_px = static_cast<float>(std::clamp(kReachOfPrior * shape.widest_px() + 2.0,
                                                    parameters.min_match_radius_px, parameters.max_match_radius_px));
  options.look_first = false;  // drawn already, for the prior's width
  const bool narrow = shape.widest_px() <= kOneStart_px;
  options.by_part = parameters.search && !narrow;
  if (narrow && parameters.method == Method::kGlCorrect) options.robust = kFollowedRobust;
  return options;
}

bool Localizer::State::begin(const Belief& belief, WorkBudget& budget) {
  if (!alternation.look_if_far(belief.prior.X_WC, budget)) return false;
  const PriorShape shape = PriorShape::of(belief.prior.covariance, alternation.motion_metric(belief.prior.X_WC));
  followed = options_of(shape);
  if (!parameters.search || shape.widest_px() <= kOneStart_px) return true;
  alternative.forget();
  if (shape.widest_px() <= parameters.max_tracking_sigma_px) {
    near.begin(belief, shape, followed);
  } else {
    search.begin(belief);
  }
  return true;
}

Correction Localizer::State::follow(const Belief& belief, WorkBudget& budget) {
  Correction answer;
  Estimate best = alternation.refine(belief.prior.X_WC, belief, perception.edges(), followed, budget);
  if (best.rounds == 0) {
    answer.reason = Reason::kNoBudget;
    return answer;
  }
  if (parameters.search && best.solved) best = alternative.better_than(best, belief, perception.edges(), budget);
  judge(best, std::nullopt, answer);
  return answer;
}

Correction Localizer::State::go_on(const Belief& belief, WorkBudget& budget) {
  Correction answer;
  answer.reason = Reason::kSearching;
  if (near.running()) {
    if (near.go_on(belief, perception.edges(), budget))
      judge(settled(near.best(), belief), Standing{.lead = near.lead(), .narrow = true}, answer);
    return answer;
  }
  if (search.go_on(belief, perception.edges(), budget))
    judge(search.best(), Standing{.lead = search.lead(), .cells = search.cells()}, answer);
  answer.starts = search.starts();
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
  s.alternation.reset_counts();
  if (s.map->edges.empty()) return refused(Reason::kNoMap);
  const Reason seen = s.perception.perceive(image, mask);
  if (seen != Reason::kNone) return refused(seen);
  const Belief belief(prior);
  if (!belief.valid) return refused(Reason::kBadPrior);

  if (!s.searching() && !s.begin(belief, budget)) return refused(Reason::kNoBudget);
  answer = s.searching() ? s.go_on(belief, budget) : s.follow(belief, budget);
  if (answer.reason == Reason::kSearching && s.alternation.looks() + s.alternation.rounds() == 0)
    return refused(Reason::kNoBudget);
  if (!answer.corrected) {
    answer.X_WC = prior.X_WC;
    answer.covariance = prior.covariance;
  }
  answer.segments = static_cast<int>(s.perception.edges().size());
  answer.looks = s.alternation.looks();
  return answer;
}

}  // namespace cgsr::localization
