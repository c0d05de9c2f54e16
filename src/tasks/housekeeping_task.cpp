#include "src/tasks/housekeeping_task.h"

#include <utility>

namespace cgsr::tasks {

void HousekeepingTask::step(MonoTime now) {
  while (const auto status = links_.motions.pop()) {
    sinks_.on_control_cycle(*status);
    motion_ = *status;
  }
  while (const auto record = links_.switchings.pop()) sinks_.on_switching(*record);
  while (const auto report = links_.reports.pop()) take(*report, now);
}

void HousekeepingTask::take(const sinks::VisionReport& report, MonoTime now) {
  if (!report.record.has_image) return sinks_.on_missing_image(report.record);
  const auto picture = picture_of(report.record.image_sequence);
  sinks_.on_image({report.frame, report.record, motion_, picture ? &*picture : nullptr, now});
}

std::optional<sinks::Picture> HousekeepingTask::picture_of(std::uint64_t sequence) {
  for (;;) {
    if (!next_picture_) next_picture_ = links_.pictures.pop();
    if (!next_picture_ || next_picture_->image.sequence() > sequence) return std::nullopt;
    auto picture = std::exchange(next_picture_, std::nullopt);
    if (picture->image.sequence() == sequence) return picture;
  }
}

}  // namespace cgsr::tasks
