#pragma once

#include <memory>
#include <string_view>

#include "pipeline/stages/task.h"
#include "platform/image_lease.h"

namespace cgsr::stages {

/// What the robot does about an image: asks its task, and passes on what stages require of the lamps. While the robot searches the whole map for its pose
/// it turns as that search asks, and its task waits.
/// Ours; the tasks are those of the dissertation (3.3.2 and Alg. 5.2) and routes.
///
/// Threads: one. Nothing here allocates.
class DecideStage {
 public:
  using Output = Decision;
  static constexpr std::string_view kName = "decide";
  static constexpr std::string_view kMeaning = "What the robot does about it.";
  static constexpr runtime::StageParameters kRow{1, 0, 1000, 1, runtime::OnOverrun::kStopMotion};

  /// \param task  not null.
  explicit DecideStage(std::unique_ptr<Task> task) : task_(std::move(task)) {}

  [[nodiscard]] Requests first_requests() const { return task_->first_requests(); }
  Output update(const ImageLease& image, const FrameResult& frame);

 private:
  std::unique_ptr<Task> task_;
  MonoTime last_image_{};
  std::string_view state_;  // of the task, at the last image
};

}  // namespace cgsr::stages
