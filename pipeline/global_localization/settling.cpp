#include "pipeline/global_localization/settling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::global_localization {
namespace {

using geometry::Pose;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kFaced = 15.0 * kDegree;       // from where a view was looked at; half of what two views are apart
constexpr double kTurnedTo = 4.0 * kDegree;     // or, by a robot that turns to it, as near as that
constexpr double kViewsApart = 20.0 * kDegree;  // less, and two looks are at the same view
constexpr double kStanding = 0.15 * kDegree;    // turned between two images, or less
constexpr int kMaxBrakingImages = 30;           // after which it is looked at from a robot that turns
constexpr int kMaxStandingImages = 60;          // although it should turn on
constexpr int kMaxUnsureImages = 15;
constexpr double kGoodView = 0.5;      // of the most matches of all views
constexpr double kManyMatches = 12.0;  // are good in any case

double square(double value) {
  return value * value;
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

}  // namespace

Settling::Settling(localization::Localizer& localizer, const geometry::Pose& X_RC,
                   const localization::PoseTrackerParameters& tracking, const GlobalLocalizerParameters& parameters)
    : X_RC_(X_RC), localizer_(&localizer), tracker_(localizer, X_RC, tracking), parameters_(parameters) {}

void Settling::begin(const Candidate& candidate, const Turn& turn) {
  views_ = candidate.views;
  for (std::size_t i = 0; i < views_.size(); ++i) {
    looked_at_[i] = std::nullopt;
    tried_[i] = std::nullopt;
    if (views_[i].matches == 0) continue;
    const Keyframe& keyframe = turn.keyframes()[i];
    tried_[i] = {views_[i].pose.X_WC * X_RC_.inverse() * turn.X_FR(keyframe).inverse(), keyframe.turned_rad};
  }
  const int most = std::ranges::max_element(views_, {}, &CorrectedView::matches)->matches;
  for (CorrectedView& view : views_) {
    if (view.matches < std::min(kGoodView * most, kManyMatches)) view.matches = 0;
  }
  view_ = std::nullopt;
  wants_turn_ = false;
  turns_back_ = false;
  images_ = 0;
  standing_images_ = 0;
  begun_rad_ = std::nullopt;
  turned_before_rad_ = 0.0;
}

std::optional<std::size_t> Settling::nearest_view(const Turn& turn, double within_rad) const {
  std::optional<std::size_t> nearest;
  for (std::size_t i = views_.size(); i-- > 0;) {
    const double apart_rad = std::abs(wrapped(turn.keyframes()[i].turned_rad - turn.turned_rad()));
    if (views_[i].matches == 0 || apart_rad > within_rad) continue;
    nearest = i;
    within_rad = apart_rad;
  }
  return nearest;
}

// To the nearest view that is worth a look, the shorter way.
void Settling::turn_on(const Turn& turn) {
  wants_turn_ = true;
  const auto view = nearest_view(turn, std::numbers::pi);
  const double to_it_rad = view ? wrapped(turn.keyframes()[*view].turned_rad - turn.turned_rad()) : 0.0;
  turns_back_ = to_it_rad * turn.keyframes().back().turned_rad < 0.0;
}

// One that turns to a view sees it whole when it stops; no nearer than it turns from image to image.
std::optional<std::size_t> Settling::faced_view(const Turn& turn) {
  standing_images_ = stands(turn) ? standing_images_ + 1 : 0;
  if (standing_images_ > kMaxStandingImages) return nearest_view(turn, std::numbers::pi);
  const double step_rad = std::abs(wrapped(turn.turned_rad() - turned_before_rad_));
  return nearest_view(turn, wants_turn_ ? std::clamp(step_rad, kTurnedTo, kFaced) : kFaced);
}

bool Settling::stands(const Turn& turn) const {
  return std::abs(wrapped(turn.turned_rad() - turned_before_rad_)) <= kStanding;
}

// From where it was looked at in the turn; a whole turn later, with what the odometry of a turn leaves.
void Settling::face(std::size_t view, const Turn& turn) {
  view_ = view;
  looking_ = false;
  braking_images_ = 0;
  standing_images_ = 0;
  const Keyframe& keyframe = turn.keyframes()[view];
  localization::Prior prior = views_[view].pose;
  if (std::abs(turn.turned_rad() - keyframe.turned_rad) > std::numbers::pi) {
    prior.covariance.topLeftCorner<2, 2>().diagonal().array() += square(parameters_.turn_sigma_m);
    prior.covariance(5, 5) += square(parameters_.turn_sigma_deg * kDegree);
  }
  tracker_.start(prior);
  X_FR_before_ = turn.X_FR(keyframe);
}

bool Settling::begins_to_look(const Turn& turn) {
  if (!stands(turn) && ++braking_images_ < kMaxBrakingImages) return false;
  localizer_->restart();
  unsure_images_ = 0;
  return true;
}

// In the map as it is: what the map itself is off by no image makes less.
bool Settling::is_sure() const {
  const geometry::Matrix6d& covariance = now().correction.covariance;
  return std::sqrt(covariance.topLeftCorner<2, 2>().trace()) <= parameters_.max_sigma_m &&
         std::sqrt(covariance(5, 5)) <= parameters_.max_sigma_deg * kDegree;
}

// With another view that was looked at before, or with most of the trial's, over what the odometry says of the turn between them.
bool Settling::agrees(const Turn& turn) const {
  const Pose X_WR = now().X_WC * X_RC_.inverse();
  const auto is_other = [&](const std::optional<Opinion>& opinion) {
    return opinion && std::abs(wrapped(turn.turned_rad() - opinion->turned_rad)) >= kViewsApart;
  };
  const auto agrees_with = [&](const Opinion& other) {
    return are_near(other.X_WF * turn.X_FR(), X_WR, parameters_.agree_m, parameters_.agree_deg * kDegree);
  };
  int others = 0;
  int agreeing = 0;
  for (std::size_t i = 0; i < kViews; ++i) {
    if (is_other(looked_at_[i]) && agrees_with(*looked_at_[i])) return true;
    if (!is_other(tried_[i])) continue;
    ++others;
    if (agrees_with(*tried_[i])) ++agreeing;
  }
  return 2 * agreeing > others;
}

std::optional<bool> Settling::update(const Turn& turn, const ImageView& image, const Motion& motion, WorkBudget& budget,
                                     const std::uint8_t* mask) {
  if (!begun_rad_) begun_rad_ = turn.turned_rad();
  if (++images_ > parameters_.max_settling_images ||
      std::abs(turn.turned_rad() - *begun_rad_) > parameters_.max_settling_turn_deg * kDegree) {
    return false;
  }
  if (!view_) {
    if (const auto view = faced_view(turn)) face(*view, turn);
  }
  wants_turn_ = false;
  if (view_ && !looking_) looking_ = begins_to_look(turn);
  turned_before_rad_ = turn.turned_rad();
  if (!view_) {
    turn_on(turn);
    return std::nullopt;
  }
  const geometry::Pose X_FR = turn.X_FR();
  tracker_.moved(X_FR_before_.inverse() * X_FR);
  tracker_.pitched(motion.pitch_rad, motion.axle_height_m);
  X_FR_before_ = X_FR;
  if (!looking_) return std::nullopt;
  tracker_.see(image, budget, mask);
  return judge(turn);
}

std::optional<bool> Settling::judge(const Turn& turn) {
  const localization::Correction& correction = now().correction;
  if (localizer_->searching() || correction.reason == localization::Reason::kNoBudget) return std::nullopt;
  const bool confirms = correction.corrected && is_sure();
  if (confirms && agrees(turn)) return true;
  if (correction.corrected && !confirms && ++unsure_images_ < kMaxUnsureImages) return std::nullopt;
  if (confirms) looked_at_[*view_] = {now().X_WC * X_RC_.inverse() * turn.X_FR().inverse(), turn.turned_rad()};
  bool any = false;
  for (std::size_t i = 0; i < kViews; ++i) {
    const double apart_rad = std::abs(wrapped(turn.keyframes()[i].turned_rad - turn.turned_rad()));
    if (i == *view_ || (confirms && apart_rad < kViewsApart)) views_[i].matches = 0;
    any = any || views_[i].matches > 0;
  }
  view_ = std::nullopt;
  looking_ = false;
  turn_on(turn);
  return any ? std::nullopt : std::optional(false);
}

}  // namespace cgsr::global_localization
