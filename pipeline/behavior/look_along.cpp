#include "pipeline/behavior/look_along.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/behavior/ramp.h"

namespace cgsr::behavior {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kNew = 0.2;  // share of a new bearing in that of somebody known

}  // namespace

std::string_view to_string(LookAlongState state) {
  switch (state) {
    case LookAlongState::kTurningAside:
      return "turning to the left end of the line";
    case LookAlongState::kLooking:
      return "looking along the line";
    case LookAlongState::kStanding:
      return "looking at somebody";
    case LookAlongState::kTelling:
      return "telling who is who";
    case LookAlongState::kDone:
      return "has told who is who";
  }
  return "unknown";
}

LookAlong::Met* LookAlong::met_at(double bearing_rad) {
  Met* nearest = nullptr;
  for (std::size_t i = 0; i < met_count_; ++i) {
    const double off = std::abs(met_[i].bearing_rad - bearing_rad);
    if (off > parameters_.same_bearing_deg * kDegree) continue;
    if (nearest == nullptr || off < std::abs(nearest->bearing_rad - bearing_rad)) nearest = &met_[i];
  }
  if (nearest != nullptr) {
    nearest->bearing_rad += kNew * (bearing_rad - nearest->bearing_rad);
    return nearest;
  }
  if (met_count_ == kMaxPeople) return nullptr;
  met_[met_count_] = {bearing_rad, 0.0, {}};
  return &met_[met_count_++];
}

// \return whether somebody in view is to be looked at longer.
bool LookAlong::note(std::span<const FaceAtBearing> faces, double elapsed_s) {
  bool stay = false;
  for (const FaceAtBearing& face : faces) {
    Met* const met = met_at(heading_rad_ + face.bearing_rad);
    if (met == nullptr) continue;
    if (face.compared) met->votes.count(face.number, face.confidence);
    if (met->votes.images() >= parameters_.images_to_name || met->waited_s >= parameters_.patience_s) continue;
    met->waited_s += elapsed_s;
    stay = true;
  }
  return stay;
}

void LookAlong::settle() {
  for (std::size_t i = 0; i < met_count_; ++i) {
    const NameVotes& votes = met_[i].votes;
    if (votes.images() > 0) line_[line_count_++] = {met_[i].bearing_rad, votes.number(), votes.confidence()};
  }
  const auto line = std::span(line_).first(line_count_);
  std::ranges::sort(line, std::ranges::greater{}, &PersonInLine::bearing_rad);
  for (PersonInLine& one : line) {
    const auto surer = [&one](const PersonInLine& other) {
      return &other != &one && other.number == one.number && other.confidence > one.confidence;
    };
    if (one.number != 0 && std::ranges::any_of(line, surer)) one.number = 0;
  }
}

LookAlongDecision LookAlong::tell() {
  if (told_ == line_count_) {
    state_ = LookAlongState::kDone;
    return {{}, state_, 0, std::nullopt};
  }
  const PersonInLine told = line_[told_++];
  return {{}, state_, static_cast<int>(told_), told};
}

LookAlongDecision LookAlong::decide(std::span<const FaceAtBearing> faces, std::optional<double> heading_rad,
                                    Duration elapsed) {
  if (state_ == LookAlongState::kDone) return {{}, state_, 0, std::nullopt};
  if (state_ == LookAlongState::kTelling) return tell();
  const double elapsed_s = to_seconds(elapsed);
  if (!heading_rad) {
    rate_radps_ = 0.0;
    return {{}, state_, 0, std::nullopt};
  }
  if (!first_heading_rad_) first_heading_rad_ = heading_rad;
  heading_rad_ = std::remainder(*heading_rad - *first_heading_rad_, 360.0 * kDegree);
  const double reach_rad = parameters_.reach_deg * kDegree;
  const bool stay = state_ != LookAlongState::kTurningAside && note(faces, elapsed_s);
  if (state_ == LookAlongState::kTurningAside) {
    if (heading_rad_ >= reach_rad) state_ = LookAlongState::kLooking;
  } else {
    state_ = stay ? LookAlongState::kStanding : LookAlongState::kLooking;
    if (!stay && heading_rad_ <= -reach_rad) {
      state_ = LookAlongState::kTelling;
      settle();
      return {{}, state_, 0, std::nullopt};
    }
  }
  const double side = state_ == LookAlongState::kTurningAside ? 1.0 : stay ? 0.0 : -1.0;
  const double target = side * std::min(parameters_.turn_degps * kDegree, limits_.max_turn_radps);
  rate_radps_ =
      ramp(rate_radps_, target, limits_.max_turn_acceleration_radps2, limits_.max_turn_acceleration_radps2, elapsed_s);
  return {{0.0, rate_radps_}, state_, 0, std::nullopt};
}

}  // namespace cgsr::behavior
