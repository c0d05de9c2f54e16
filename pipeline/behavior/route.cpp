#include "pipeline/behavior/route.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/core.h>

#include "pipeline/behavior/ramp.h"

namespace cgsr::behavior {
namespace {

constexpr double kFarthest_m = 10000.0;

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

std::optional<double> number_of(std::string_view text) {
  text = trimmed(text);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= kFarthest_m)) return {};
  return value;
}

}  // namespace

Result<std::vector<Place>> parse_places(std::string_view text) {
  std::vector<Place> places;
  while (!trimmed(text).empty()) {
    const auto end = text.find(';');
    const std::string_view piece = trimmed(text.substr(0, end));
    const auto comma = piece.find(',');
    const auto x = number_of(piece.substr(0, comma));
    const auto y = comma == std::string_view::npos ? std::nullopt : number_of(piece.substr(comma + 1));
    if (!x || !y) {
      return fail(fmt::format("place {} is '{}'; expected two numbers in metres, such as '1.5, 2.25'",
                              places.size() + 1, piece));
    }
    places.push_back({*x, *y});
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  }
  return places;
}

std::string_view to_string(RouteState state) {
  switch (state) {
    case RouteState::kNowhere:
      return "pose not known, standing";
    case RouteState::kDriving:
      return "on its way";
    case RouteState::kArrived:
      return "arrived";
  }
  return "unknown";
}

RouteDecision Route::decide(const PlanarPose& here, Duration elapsed) {
  RouteDecision decision;
  const double elapsed_s = std::clamp(to_seconds(elapsed), 0.0, 0.2);
  if (!here.known) {
    goal_ = {};
    decision.halt = true;
    return decision;
  }
  pass_places(here);
  decision.state = at_end() ? RouteState::kArrived : RouteState::kDriving;
  decision.place = static_cast<int>(next_);
  const Velocity target = at_end() ? Velocity{} : wanted(here);
  goal_.forward_mps = ramp(goal_.forward_mps, target.forward_mps, limits_.max_acceleration_mps2,
                           limits_.max_deceleration_mps2, elapsed_s);
  goal_.left_radps = ramp(goal_.left_radps, target.left_radps, limits_.max_turn_acceleration_radps2,
                          limits_.max_turn_acceleration_radps2, elapsed_s);
  decision.goal = goal_;
  return decision;
}

void Route::pass_places(const PlanarPose& here) {
  for (std::size_t passed = 0; passed < places_.size() && !at_end(); ++passed) {
    const Place& place = places_[next_];
    if (std::hypot(place.x_m - here.x_m, place.y_m - here.y_m) > parameters_.reached_m) return;
    ++next_;
    if (at_end() && parameters_.round && places_.size() > 1) next_ = 0;
  }
}

Velocity Route::wanted(const PlanarPose& here) const {
  const Place& place = places_[next_];
  const double way_m = std::hypot(place.x_m - here.x_m, place.y_m - here.y_m);
  const double bearing =
      std::remainder(std::atan2(place.y_m - here.y_m, place.x_m - here.x_m) - here.heading_rad, 2.0 * std::numbers::pi);
  const double facing = std::max(0.0, 1.0 - std::abs(bearing) / parameters_.max_driving_bearing_rad);
  return {std::min({parameters_.forward_mps, limits_.max_forward_mps, parameters_.approach_per_s * way_m}) * facing,
          std::clamp(parameters_.turn_per_s * bearing, -limits_.max_turn_radps, limits_.max_turn_radps)};
}

}  // namespace cgsr::behavior
