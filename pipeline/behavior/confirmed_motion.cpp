#include "pipeline/behavior/confirmed_motion.h"

#include <cmath>

namespace cgsr::behavior {
namespace {

constexpr double kSmoothing_s = 0.5;

}  // namespace

void ConfirmedMotion::turned(double left_radps, double elapsed_s) {
  time_s_ += elapsed_s;
  heading_rad_ += left_radps * elapsed_s;
}

void ConfirmedMotion::seen(double bearing_rad) {
  if (count_ == kMaxPending) {
    confirm(pending_[first_]);
    first_ = (first_ + 1) % kMaxPending;
    --count_;
  }
  pending_[(first_ + count_++) % kMaxPending] = {time_s_, bearing_rad, heading_rad_ + bearing_rad};
  while (count_ > 0 && pending_[first_].time_s <= time_s_ - confirm_s_) {
    confirm(pending_[first_]);
    first_ = (first_ + 1) % kMaxPending;
    --count_;
  }
}

void ConfirmedMotion::lost() {
  count_ = 0;
  interrupted_ = true;
}

void ConfirmedMotion::confirm(const Sighting& sighting) {
  const double elapsed_s = sighting.time_s - last_.time_s;
  if (!confirmed_ || interrupted_) {
    rate_radps_ = 0.0;
  } else if (elapsed_s > 0.0) {
    const double rate_radps = (sighting.direction_rad - last_.direction_rad) / elapsed_s;
    rate_radps_ += (1.0 - std::exp(-elapsed_s / kSmoothing_s)) * (rate_radps - rate_radps_);
  }
  confirmed_ = true;
  interrupted_ = false;
  last_ = sighting;
}

}  // namespace cgsr::behavior
