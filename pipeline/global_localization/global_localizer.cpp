#include "pipeline/global_localization/global_localizer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace cgsr::global_localization {
namespace {

using geometry::Pose;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kFirstKeyframes = 4;  // of which the trial begins with the richest

// Between two images of the turn the heading is known better than by the odometry alone, and the place less well: no base pivots on a point.
localization::PoseTrackerParameters for_turn(localization::PoseTrackerParameters tracking,
                                             const GlobalLocalizerParameters& parameters) {
  tracking.slip_turn = std::min(tracking.slip_turn, parameters.slip_turn);
  tracking.drift_m = std::max(tracking.drift_m, parameters.drift_m);
  return tracking;
}

bool is_sure(const geometry::Matrix6d& covariance, const GlobalLocalizerParameters& parameters) {
  return std::sqrt(covariance.topLeftCorner<2, 2>().trace()) <= parameters.max_sigma_m &&
         std::sqrt(covariance(5, 5)) <= parameters.max_sigma_deg * kDegree;
}

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
      tracker_(localizer, X_RC, for_turn(tracking, parameters)),
      live_(localizer, X_RC, tracking),
      turn_(camera, X_RC, parameters.max_drift_m),
      index_(map, localization::working_camera(camera).without_distortion(), X_RC, std::move(places_m)),
      search_(index_, parameters) {}

void GlobalLocalizer::restart() {
  phase_ = Phase::kTurning;
  turn_.restart();
  closed_ = false;
  gathered_ = false;
  search_.restart();
  trial_ = 0;
  under_trial_ = false;
  settling_images_ = 0;
  localizer_->restart();
}

Phase GlobalLocalizer::update(const ImageView& image, const Motion& motion, WorkBudget& budget,
                              const std::uint8_t* mask) {
  if (phase_ == Phase::kTurning) {
    const bool looked = turn_.looks_at(motion);
    if (turn_.see(image, motion, mask)) {
      phase_ = Phase::kComparing;
    } else if (!looked) {
      index_.build(budget);
    }
  } else if (phase_ == Phase::kComparing) {
    if (!std::exchange(closed_, true)) {
      turn_.close();
    } else if (!std::exchange(gathered_, true)) {
      turn_.gather(seen_);
    } else if (index_.build(budget) && search_.go_on(seen_, budget)) {
      phase_ = search_.candidates().empty() ? Phase::kNotFound : Phase::kTrying;
    }
  } else if (phase_ == Phase::kTrying) {
    if (try_candidates(budget, mask)) phase_ = verdict();
  } else if (phase_ == Phase::kSettling) {
    settle(image, motion, budget, mask);
  }
  return phase_;
}

bool GlobalLocalizer::looks_at(const Motion& motion) const {
  return phase_ == Phase::kSettling || (phase_ == Phase::kTurning && turn_.looks_at(motion));
}

bool GlobalLocalizer::worth_trying(const Candidate& candidate) const {
  const bool any = std::ranges::any_of(
      search_.candidates(), [&](const Candidate& c) { return c.tried && c.corrected >= parameters_.min_corrected; });
  return !any || static_cast<double>(candidate.likeness) >=
                     parameters_.min_likeness_share * static_cast<double>(search_.candidates().front().likeness);
}

void GlobalLocalizer::begin_trial(const Candidate& candidate) {
  const auto richer = [](const Keyframe& a, const Keyframe& b) { return a.edges_px < b.edges_px; };
  const auto first = turn_.keyframes().first(kFirstKeyframes);
  const auto richest = std::ranges::max_element(first, richer);
  next_keyframe_ = static_cast<std::size_t>(richest - first.begin());
  localization::PriorSigmas sigmas = localization::PriorSigmas::floor();
  sigmas.x_m = sigmas.y_m = parameters_.place_sigma_m;
  sigmas.heading_rad = parameters_.heading_sigma_deg * kDegree;
  const Pose X_R0R = turn_.X_FR(*richest);
  tracker_.start(localization::prior_at(candidate.X_WR * X_R0R * X_RC_, sigmas));
  failed_ = 0;
  under_trial_ = true;
  looking_ = false;
}

void GlobalLocalizer::end_trial(Candidate& candidate) {
  candidate.tried = true;
  candidate.last = {.X_WC = tracker_.now().X_WC, .covariance = tracker_.now().covariance};
  const Pose X_R0R = turn_.X_FR(turn_.keyframes().back());
  if (candidate.corrected > 0) candidate.X_WR = candidate.last.X_WC * X_RC_.inverse() * X_R0R.inverse();
  under_trial_ = false;
  ++trial_;
}

bool GlobalLocalizer::try_candidates(WorkBudget& budget, const std::uint8_t* mask) {
  while (trial_ < search_.candidates().size()) {
    Candidate& candidate = search_.candidates()[trial_];
    if (!under_trial_) {
      if (!worth_trying(candidate)) return true;
      begin_trial(candidate);
    }
    while (next_keyframe_ < turn_.keyframes().size() && (candidate.corrected > 0 || failed_ < parameters_.max_failed)) {
      const Keyframe& keyframe = turn_.keyframes()[next_keyframe_];
      if (!looking_) {
        tracker_.pitched(keyframe.motion.pitch_rad, keyframe.motion.axle_height_m);
        looking_ = true;
      }
      const localization::TrackedPose& pose = tracker_.see(keyframe.image, budget, mask);
      if (localizer_->searching() || pose.correction.reason == localization::Reason::kNoBudget) return false;
      looking_ = false;
      candidate.corrected += pose.correction.corrected ? 1 : 0;
      failed_ += pose.correction.corrected ? 0 : 1;
      ++next_keyframe_;
      if (next_keyframe_ < turn_.keyframes().size()) {
        const Keyframe& next = turn_.keyframes()[next_keyframe_];
        tracker_.moved(turn_.X_FR(keyframe).inverse() * turn_.X_FR(next));
      }
      return false;  // edges are perceived once an image
    }
    end_trial(candidate);
  }
  return true;
}

Phase GlobalLocalizer::verdict() {
  const Candidate* best = nullptr;
  for (const Candidate& c : search_.candidates()) {
    if (c.tried && (best == nullptr || c.corrected > best->corrected)) best = &c;
  }
  if (best == nullptr || best->corrected < parameters_.min_corrected) return Phase::kNotFound;
  for (const Candidate& c : search_.candidates()) {
    if (!c.tried || are_near(c.X_WR, best->X_WR, parameters_.same_m, parameters_.same_deg * kDegree)) continue;
    if (c.corrected > parameters_.max_rival_share * best->corrected) return Phase::kAmbiguous;
  }
  begin_settling(*best);
  return Phase::kSettling;
}

void GlobalLocalizer::begin_settling(const Candidate& candidate) {
  live_.start(candidate.last);
  X_LR_before_ = Pose::Identity();
  settling_images_ = 0;
}

void GlobalLocalizer::settle(const ImageView& image, const Motion& motion, WorkBudget& budget,
                             const std::uint8_t* mask) {
  const Pose X_LR = turn_.X_LR(motion);
  live_.moved(X_LR_before_.inverse() * X_LR);
  X_LR_before_ = X_LR;
  live_.pitched(motion.pitch_rad, motion.axle_height_m);
  live_.see(image, budget, mask);
  if (live_.now().correction.corrected && is_sure(live_.now().covariance, parameters_)) {
    phase_ = Phase::kFound;
    settling_images_ = 0;
  } else if (live_.now().correction.reason != localization::Reason::kSearching &&
             ++settling_images_ >= parameters_.max_settling_images) {
    phase_ = Phase::kNotFound;
    settling_images_ = 0;
  }
}

}  // namespace cgsr::global_localization
