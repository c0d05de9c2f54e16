#pragma once

#include <optional>

#include "pipeline/localization/pose_tracker.h"
#include "platform/time.h"

namespace cgsr::stages {

/// For how long a pose has been lost although images could have corrected it.
///
/// The time of an image that is dark, covered or without edges, or from where the map shows nothing, does not count: it says nothing against the pose.
/// While the localizer searches about the lost pose its time waits for the answer, and counts with it or does not. Ours.
class TimeLost {
 public:
  /// \param pose  as an image left it.  \param stamp  of that image's exposure.
  void add(const localization::TrackedPose& pose, MonoTime stamp);

  /// Counts nothing more of the present loss.
  void give_up();

  /// \return of the present loss; zero while there is none, and after give_up().
  [[nodiscard]] Duration lasted() const { return lasted_; }

 private:
  std::optional<MonoTime> last_;
  Duration lasted_ = Duration::zero();
  Duration unanswered_ = Duration::zero();  ///< of the search under way.
  bool given_up_ = false;
};

}  // namespace cgsr::stages
