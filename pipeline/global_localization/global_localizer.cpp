#include "pipeline/global_localization/global_localizer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace cgsr::global_localization {
namespace {

using geometry::Pose;

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::size_t kLeastLooks = 6;

}  // namespace

std::string_view to_string(Phase phase) {
  switch (phase) {
    case Phase::kTurning:
      return "turning";
    case Phase::kComparing:
      return "comparing";
    case Phase::kTrying:
      return "trying";
    case Phase::kSettling:
      return "settling";
    case Phase::kFound:
      return "found";
    case Phase::kAmbiguous:
      return "ambiguous";
    case Phase::kNotFound:
      return "not_found";
  }
  return "";
}

GlobalLocalizer::GlobalLocalizer(const world::Map& map, const geometry::Camera& camera, const Pose& X_RC,
                                 std::vector<Eigen::Vector2d> places_m, localization::Localizer& localizer,
                                 const localization::PoseTrackerParameters& tracking,
                                 const GlobalLocalizerParameters& parameters)
    : X_RC_(X_RC),
      parameters_(parameters),
      localizer_(&localizer),
      tracker_(localizer, X_RC, tracking),
      settling_(localizer, X_RC, tracking, parameters),
      turn_(camera, X_RC, parameters.max_drift_m),
      index_(map, localization::working_camera(camera).without_distortion(), X_RC, std::move(places_m),
             parameters.spacing_m),
      search_(index_, parameters),
      fit_(localizer, X_RC, parameters) {}

void GlobalLocalizer::restart() {
  phase_ = Phase::kTurning;
  turn_.restart();
  closed_ = false;
  gathered_ = false;
  search_.restart();
  trial_ = 0;
  under_trial_ = false;
  looking_ = false;
  localizer_->restart();
}

Phase GlobalLocalizer::update(const ImageView& image, const Motion& motion, WorkBudget& budget,
                              const std::uint8_t* mask) {
  if (phase_ != Phase::kTurning) turn_.follow(motion);
  if (phase_ == Phase::kTurning) {
    const bool looked = turn_.looks_at(motion);
    if (turn_.see(image, motion, mask)) {
      phase_ = Phase::kComparing;
    } else if (turn_.leads_nowhere()) {
      phase_ = Phase::kNotFound;
    } else if (!looked) {
      index_.build(budget);
    }
  } else if (phase_ == Phase::kComparing) {
    if (!std::exchange(closed_, true)) {
      turn_.close();
    } else if (!std::exchange(gathered_, true)) {
      turn_.gather(seen_);
    } else if (search_.go_on(seen_, budget)) {
      phase_ = search_.candidates().empty() ? Phase::kNotFound : Phase::kTrying;
      choose_order();
    }
  } else if (phase_ == Phase::kTrying) {
    if (try_candidates(budget, mask)) phase_ = verdict();
  } else if (phase_ == Phase::kSettling) {
    const auto confirmed = settling_.update(turn_, image, motion, budget, mask);
    if (confirmed) phase_ = *confirmed ? Phase::kFound : Phase::kNotFound;
  }
  return phase_;
}

bool GlobalLocalizer::looks_at(const Motion& motion) const {
  return phase_ == Phase::kSettling || (phase_ == Phase::kTurning && turn_.looks_at(motion));
}

bool GlobalLocalizer::worth_trying(const Candidate& candidate) const {
  return is_nearly_as_alike(candidate) || !any_is_corrected();
}

bool GlobalLocalizer::any_is_corrected() const {
  return std::ranges::any_of(search_.candidates(), [this](const Candidate& c) { return is_corrected(c); });
}

bool GlobalLocalizer::is_nearly_as_alike(const Candidate& candidate) const {
  return static_cast<double>(candidate.likeness) >=
         parameters_.min_likeness_share * static_cast<double>(search_.candidates().front().likeness);
}

// In enough images. The panorama speaks for the most alike one where it speaks for no other: fewer will do then, if they are half of those looked at.
bool GlobalLocalizer::is_corrected(const Candidate& candidate) const {
  const auto candidates = search_.candidates();
  if (!candidate.tried) return false;
  if (candidate.corrected >= parameters_.min_corrected) return true;
  const bool alone = &candidate == candidates.data() && (candidates.size() == 1 || !is_nearly_as_alike(candidates[1]));
  return alone && candidate.corrected >= parameters_.min_corrected_alone &&
         2 * candidate.corrected >= candidate.looked_at;
}

// From the image that shows most around to the last one, the shorter way, and on; the last one stands for the one that it looks like. A look at a bare wall
// takes longest and says least: those are left out.
void GlobalLocalizer::choose_order() {
  const std::size_t closing = turn_.closing_view();
  const auto keyframe_at = [closing](std::size_t view) { return view == closing ? kKeyframes : view; };
  std::array<float, kKeyframes> edges_px{};
  for (std::size_t view = 0; view < kKeyframes; ++view) edges_px[view] = turn_.keyframes()[keyframe_at(view)].edges_px;
  const auto richest = static_cast<std::size_t>(std::ranges::max_element(edges_px) - edges_px.begin());
  auto sorted = edges_px;
  std::ranges::sort(sorted, std::greater<>());
  const float enough_px =
      std::min(static_cast<float>(parameters_.min_edges_share) * sorted.front(), sorted[kLeastLooks - 1]);
  const std::size_t forward = (closing + kKeyframes - richest) % kKeyframes;
  const std::size_t step = 2 * forward <= kKeyframes ? 1 : kKeyframes - 1;
  looks_ = 0;
  for (std::size_t i = 0; i < kKeyframes; ++i) {
    const std::size_t view = (richest + i * step) % kKeyframes;
    if (edges_px[view] < enough_px && view != closing) continue;
    order_[static_cast<std::size_t>(looks_++)] = keyframe_at(view);
    if (view == closing) looks_to_last_ = looks_;
  }
}

int GlobalLocalizer::most_failed() const {
  if (trial_ == 0) return parameters_.max_failed;
  return any_is_corrected() ? parameters_.max_failed_rival : parameters_.max_failed_fitted;
}

bool GlobalLocalizer::goes_on(const Candidate& candidate) const {
  if (candidate.looked_at >= looks_) return false;
  if (candidate.corrected == 0) return candidate.looked_at < most_failed();
  return candidate.corrected < parameters_.enough_corrected || candidate.looked_at < looks_to_last_;
}

void GlobalLocalizer::end_trial(Candidate& candidate) {
  candidate.tried = true;
  if (candidate.corrected > 0) {
    candidate.X_WR = candidate.views[candidate.last_corrected].pose.X_WC * X_RC_.inverse() *
                     turn_.X_FR(turn_.keyframes()[candidate.last_corrected]).inverse();
  }
  under_trial_ = false;
  localizer_->restart();
  ++trial_;
}

// Whether all images together have told where the candidate is.
bool GlobalLocalizer::fit(const Candidate& candidate, WorkBudget& budget) {
  if (!std::exchange(under_trial_, true)) {
    fit_.begin(candidate.X_WR);
    fitted_ = false;
  }
  if (!fitted_) fitted_ = fit_.go_on(turn_, budget);
  return fitted_;
}

// Beside an image that corrected it the candidate is where that says; before, where the fit says; and where that leads nowhere, where its panorama does.
localization::Prior GlobalLocalizer::prior_of_look(const Candidate& candidate) const {
  const auto prior = [&](const Pose& X_WR, double sigma_m, double sigma_deg) {
    localization::PriorSigmas sigmas = localization::PriorSigmas::floor();
    sigmas.x_m = sigmas.y_m = sigma_m;
    sigmas.heading_rad = sigma_deg * kDegree;
    return localization::prior_at(X_WR * X_RC_, sigmas);
  };
  const GlobalLocalizerParameters& p = parameters_;
  const Keyframe& keyframe = turn_.keyframes()[order_[static_cast<std::size_t>(candidate.looked_at)]];
  if (candidate.corrected > 0) {
    const Keyframe& last = turn_.keyframes()[candidate.last_corrected];
    const Pose X_WR_last = candidate.views[candidate.last_corrected].pose.X_WC * X_RC_.inverse();
    if (!follows_fit_)
      return prior(X_WR_last * turn_.X_FR(last).inverse() * turn_.X_FR(keyframe), p.fitted_sigma_m, p.fitted_sigma_deg);
    return prior(X_WR_last * fit_.X_WR(turn_, last).inverse() * fit_.X_WR(turn_, keyframe), p.corrected_sigma_m,
                 p.corrected_sigma_deg);
  }
  if (candidate.looked_at < p.max_failed_fitted)
    return prior(fit_.X_WR(turn_, keyframe), p.fitted_sigma_m, p.fitted_sigma_deg);
  return prior(candidate.X_WR * turn_.X_FR(keyframe), p.place_sigma_m, p.heading_sigma_deg);
}

// Each look takes as many images as the localizer searches.
void GlobalLocalizer::look_at_next(Candidate& candidate, WorkBudget& budget, const std::uint8_t* mask) {
  const std::size_t view = order_[static_cast<std::size_t>(candidate.looked_at)];
  const Keyframe& keyframe = turn_.keyframes()[view];
  if (!std::exchange(looking_, true)) {
    tracker_.start(prior_of_look(candidate));
    tracker_.pitched(keyframe.motion.pitch_rad, keyframe.motion.axle_height_m);
  }
  const localization::Correction& correction = tracker_.see(keyframe.image, budget, mask).correction;
  if (localizer_->searching() || correction.reason == localization::Reason::kNoBudget) return;
  looking_ = false;
  if (correction.corrected) {
    if (candidate.corrected++ == 0) follows_fit_ = candidate.looked_at < parameters_.max_failed_fitted;
    candidate.last_corrected = view;
    candidate.views[view] = {correction.matches, {correction.X_WC, correction.covariance}};
  }
  ++candidate.looked_at;
}

bool GlobalLocalizer::try_candidates(WorkBudget& budget, const std::uint8_t* mask) {
  while (trial_ < search_.candidates().size()) {
    Candidate& candidate = search_.candidates()[trial_];
    if (!under_trial_ && !worth_trying(candidate)) return true;
    if (!fit(candidate, budget)) return false;
    if (goes_on(candidate)) {
      look_at_next(candidate, budget, mask);
      return false;  // edges are perceived once an image
    }
    end_trial(candidate);
  }
  return true;
}

Phase GlobalLocalizer::verdict() {
  const auto share = [](const Candidate& c) { return static_cast<double>(c.corrected) / std::max(1, c.looked_at); };
  const auto better = [&share](const Candidate& a, const Candidate& b) {
    return a.corrected != b.corrected ? a.corrected > b.corrected : share(a) > share(b);
  };
  const Candidate* best = nullptr;
  for (const Candidate& c : search_.candidates()) {
    if (c.tried && (best == nullptr || better(c, *best))) best = &c;
  }
  if (best == nullptr || !is_corrected(*best)) return Phase::kNotFound;
  for (const Candidate& c : search_.candidates()) {
    if (!c.tried || are_near(c.X_WR, best->X_WR, parameters_.same_m, parameters_.same_deg * kDegree)) continue;
    if (share(c) > parameters_.max_rival_share * share(*best)) return Phase::kAmbiguous;
  }
  settling_.begin(*best, turn_);
  return Phase::kSettling;
}

}  // namespace cgsr::global_localization
