#pragma once

#include <string_view>

#include "pipeline/behavior/fill_light_parameters.h"
#include "platform/time.h"

namespace cgsr::behavior {

/// What is known of the face of the person of interest.
struct FaceEvidence {
  bool expected =
      false;  ///< somebody is there by another characteristic and his face would be within the image, or nobody is known to be there and a face is waited for.
  bool seen = false;  ///< a face is there; where nobody is known to be, one of which it is known whose it is.
  double dark =
      0.0;  ///< the share of the pixels at its place that are too dark for a hue, in [0, 1]; where one is expected or seen.
  bool lost = false;  ///< nobody is seen by anything.
};

struct FillLightDecision {
  bool on = false;
  bool changed = false;     ///< in this image.
  std::string_view reason;  ///< of the change; text that lives as long as the program.
};

/// When the light under the camera shines on a face (6.4.1.1: the detector found a dark-skinned face only with a light on it).
///
///   off -> on   somebody has been there for no_face_s without a face, and its place is dark (min_dark)
///   on -> off   a face was seen for face_s together, or nobody has been there for gone_s, or max_on_s are over
///   off -> on   it has just gone out after it showed a face, and whoever was there is not seen by anything in some images: it is held on now, whether a
///               face is seen or not, until one of the two other reasons
///
/// Where faces were seen in the dark without it for face_s, it is not needed: whoever turns away shows no face in any light, and it stays off until none was seen
/// for rest_s, or nobody was there for gone_s. Otherwise it stays off for rest_s afterwards, or for fruitless_rest_s where it showed no face: it cannot flicker, however the light itself changes what is seen.
/// While it is on, darkness is not asked. Ours.
///
/// Threads: one. Allocates nothing.
class FillLight {
 public:
  explicit FillLight(const FillLightParameters& parameters) : parameters_(parameters) {}

  /// One image. \param elapsed  since the last one; negative counts as zero.
  FillLightDecision decide(const FaceEvidence& evidence, Duration elapsed);
  [[nodiscard]] double max_waiting_luma() const { return parameters_.max_waiting_luma; }

 private:
  [[nodiscard]] std::string_view reason_to_end() const;
  FillLightDecision turn(bool on, std::string_view reason);
  [[nodiscard]] std::string_view reason_to_begin(const FaceEvidence& evidence, double passed_s);
  [[nodiscard]] bool is_needed(const FaceEvidence& evidence, double passed_s);

  FillLightParameters parameters_;
  bool on_ = false;
  double in_state_s_ = 0.0;       // since it was switched
  double faceless_s_ = 0.0;       // somebody there in the dark without a face, without a break
  double face_s_ = 0.0;           // with a face since it is on, all together
  double gone_s_ = 0.0;           // with nobody there, without a break
  double lost_s_ = 0.0;           // off, with nobody seen by anything, all together
  double rest_s_ = 0.0;           // how long it has to stay off now
  double without_s_ = 0.0;        // with a face in the dark while it was off, all together
  double since_without_s_ = 0.0;  // since the last of them
  double nobody_s_ = 0.0;         // off, with nobody seen by anything, without a break
  bool has_shown_ = false;        // a face, when it was on last
  bool held_ = false;             // without it nobody was seen
};

}  // namespace cgsr::behavior
