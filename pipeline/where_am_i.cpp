#include "pipeline/where_am_i.h"

#include <utility>

#include "pipeline/localization/perceive.h"

namespace cgsr {

WhereAmI::WhereAmI(KnownSelf self)
    : map_(std::move(self.map)),
      X_CR_(self.X_RC.inverse()),
      axle_height_m_(self.axle_height_m),
      camera_(self.camera),
      working_(localization::working_camera(self.camera)),
      localizer_(*map_, self.camera, self.localizer, std::move(self.expectation)),
      tracker_(localizer_, self.X_RC, self.tracking),
      own_pixels_(std::move(self.own_pixels)),
      odometry_(self.odometry) {
  tracker_.start(self.start);
}

const localization::TrackedPose& WhereAmI::look(const ImageView& grey, MonoTime stamp, WorkBudget& budget) {
  if (const auto odometry = odometry_.at(stamp)) {
    const geometry::Pose X_OR = pose_of(*odometry, axle_height_m_);
    if (X_OR_) tracker_.moved(X_OR_->inverse() * X_OR);
    X_OR_ = X_OR;
    tracker_.pitched(odometry->pitch_rad, axle_height_m_);
  }
  return tracker_.see(grey, budget, own_pixels_.empty() ? nullptr : own_pixels_.data());
}

}  // namespace cgsr
