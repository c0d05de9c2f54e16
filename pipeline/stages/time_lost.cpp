#include "pipeline/stages/time_lost.h"

#include <algorithm>

namespace cgsr::stages {
namespace {

using localization::Reason;

constexpr Duration kLongestStep = seconds(0.5);  // between two images; in a longer gap there were none

// Whether the image would have corrected a pose that is right, as far as one can say.
bool speaks_against_the_pose(Reason reason) {
  switch (reason) {
    case Reason::kTooFewMatches:
    case Reason::kUnexplained:
    case Reason::kAmbiguous:
    case Reason::kFarFromPrior:
    case Reason::kUncertain:
    case Reason::kResidual:
      return true;
    case Reason::kNone:
    case Reason::kSearching:
    case Reason::kWrongSize:
    case Reason::kNoMap:
    case Reason::kTooDark:
    case Reason::kTooBright:
    case Reason::kTooFewEdges:
    case Reason::kNothingExpected:
    case Reason::kBadPrior:
    case Reason::kNoBudget:
      return false;
  }
  return false;
}

}  // namespace

void TimeLost::add(const localization::TrackedPose& pose, MonoTime stamp) {
  const Duration step = last_ ? std::clamp(stamp - *last_, Duration::zero(), kLongestStep) : Duration::zero();
  last_ = stamp;
  if (pose.state != localization::TrackState::kLost) {
    lasted_ = unanswered_ = Duration::zero();
    given_up_ = false;
    return;
  }
  if (given_up_) return;
  const Reason reason = pose.correction.reason;
  if (reason == Reason::kSearching) {
    unanswered_ += step;
  } else if (speaks_against_the_pose(reason)) {
    lasted_ += unanswered_ + step;
    unanswered_ = Duration::zero();
  } else if (reason == Reason::kNothingExpected) {
    unanswered_ = Duration::zero();
  }
}

void TimeLost::give_up() {
  lasted_ = unanswered_ = Duration::zero();
  given_up_ = true;
}

}  // namespace cgsr::stages
