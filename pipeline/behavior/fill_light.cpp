#include "pipeline/behavior/fill_light.h"

#include <algorithm>

namespace cgsr::behavior {

std::string_view FillLight::reason_to_end() const {
  if (face_s_ >= parameters_.face_s) return "a face was seen long enough";
  if (gone_s_ >= parameters_.gone_s) return "nobody is there";
  if (in_state_s_ >= parameters_.max_on_s) return "it was on for long enough";
  return {};
}

FillLightDecision FillLight::turn(bool on, std::string_view reason) {
  on_ = on;
  in_state_s_ = faceless_s_ = face_s_ = gone_s_ = 0.0;
  return {on_, true, reason};
}

FillLightDecision FillLight::decide(const FaceEvidence& evidence, Duration elapsed) {
  const double passed_s = std::max(0.0, to_seconds(elapsed));
  in_state_s_ += passed_s;
  if (!on_) {
    const bool faceless = evidence.expected && !evidence.seen && evidence.dark >= parameters_.min_dark;
    faceless_s_ = faceless ? faceless_s_ + passed_s : 0.0;
    if (in_state_s_ >= rest_s_ && faceless_s_ >= parameters_.no_face_s)
      return turn(true, "no face where one should be, and it is dark");
    return {on_, false, {}};
  }
  if (evidence.seen) face_s_ += passed_s;
  gone_s_ = evidence.seen || evidence.expected ? 0.0 : gone_s_ + passed_s;
  const std::string_view reason = reason_to_end();
  if (reason.empty()) return {on_, false, {}};
  rest_s_ = face_s_ > 0.0 ? parameters_.rest_s : parameters_.fruitless_rest_s;
  return turn(false, reason);
}

}  // namespace cgsr::behavior
