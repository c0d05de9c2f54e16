#include "pipeline/behavior/fill_light.h"

#include <algorithm>

namespace cgsr::behavior {

std::string_view FillLight::reason_to_end() const {
  if (!held_ && face_s_ >= parameters_.face_s) return "a face was seen long enough";
  if (gone_s_ >= parameters_.gone_s) return "nobody is there";
  if (in_state_s_ >= parameters_.max_on_s) return "it was on for long enough";
  return {};
}

bool FillLight::is_needed(const FaceEvidence& evidence, double passed_s) {
  since_without_s_ += passed_s;
  if (evidence.seen && evidence.dark >= parameters_.min_dark) {
    without_s_ += passed_s;
    since_without_s_ = 0.0;
  }
  nobody_s_ = evidence.lost ? nobody_s_ + passed_s : 0.0;
  const bool another_may_come = nobody_s_ >= parameters_.gone_s;
  if (since_without_s_ >= parameters_.rest_s || another_may_come) without_s_ = 0.0;
  return without_s_ < parameters_.face_s;
}

std::string_view FillLight::reason_to_begin(const FaceEvidence& evidence, double passed_s) {
  constexpr double kJust_s = 4.0, kLost_s = 0.3;
  const bool needed = is_needed(evidence, passed_s);
  const bool faceless = needed && evidence.expected && !evidence.seen && evidence.dark >= parameters_.min_dark;
  faceless_s_ = faceless ? faceless_s_ + passed_s : 0.0;
  lost_s_ += evidence.lost ? passed_s : 0.0;
  held_ = needed && has_shown_ && evidence.dark >= parameters_.min_dark && in_state_s_ <= kJust_s && lost_s_ >= kLost_s;
  if (held_) return "nobody is seen without it";
  if (in_state_s_ < rest_s_ || faceless_s_ < parameters_.no_face_s) return {};
  return "no face where one should be, and it is dark";
}

FillLightDecision FillLight::turn(bool on, std::string_view reason) {
  on_ = on;
  without_s_ = since_without_s_ = nobody_s_ = 0.0;
  in_state_s_ = faceless_s_ = face_s_ = gone_s_ = lost_s_ = 0.0;
  return {on_, true, reason};
}

FillLightDecision FillLight::decide(const FaceEvidence& evidence, Duration elapsed) {
  const double passed_s = std::max(0.0, to_seconds(elapsed));
  in_state_s_ += passed_s;
  if (!on_) {
    const std::string_view why = reason_to_begin(evidence, passed_s);
    return why.empty() ? FillLightDecision{on_, false, {}} : turn(true, why);
  }
  if (evidence.seen) face_s_ += passed_s;
  const bool left = evidence.lost && face_s_ > 0.0;  // whom it showed
  gone_s_ = evidence.seen || (evidence.expected && !left) ? 0.0 : gone_s_ + passed_s;
  const std::string_view reason = reason_to_end();
  if (reason.empty()) return {on_, false, {}};
  has_shown_ = face_s_ > 0.0;
  rest_s_ = has_shown_ ? parameters_.rest_s : parameters_.fruitless_rest_s;
  return turn(false, reason);
}

}  // namespace cgsr::behavior
