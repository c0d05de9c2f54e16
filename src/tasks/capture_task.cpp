#include "src/tasks/capture_task.h"

#include <utility>

namespace cgsr::tasks {
namespace {

void count(std::atomic<std::uint64_t>& counter) {
  counter.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

int CaptureTask::pass_over_waiting(const Clock& clock) {
  constexpr int kMost = 32;  // as many buffers as a V4L2 driver has
  constexpr Duration kNoWait = seconds(0.001);
  int given_back = 0;
  for (; given_back < kMost; ++given_back) {
    const auto image = camera_.next_image(clock.now() + kNoWait);
    if (!image && image.error() != hal::CaptureFailure::kCorrupt) break;
  }
  return given_back;
}

bool CaptureTask::step(MonoTime give_up_at) {
  auto image = camera_.next_image(give_up_at);
  if (image) {
    count(links_.capture.images);
    // A full ring means that vision is far behind; it takes the newest of what is there, and this image is counted as dropped.
    static_cast<void>(links_.images.push(std::move(*image)));
    links_.image_came.wake();
    return true;
  }
  switch (image.error()) {
    case hal::CaptureFailure::kTimeout:
      count(links_.capture.timeouts);
      return true;
    case hal::CaptureFailure::kNoSlot:
      count(links_.capture.no_slot);
      return true;
    case hal::CaptureFailure::kCorrupt:
      count(links_.capture.corrupt);
      return true;
    case hal::CaptureFailure::kDisconnected:
      count(links_.capture.disconnected);
      links_.camera_lost.store(true, std::memory_order_release);
      break;
    case hal::CaptureFailure::kEndOfStream:
      links_.images_ended.store(true, std::memory_order_release);
      break;
  }
  links_.image_came.wake();
  return false;
}

}  // namespace cgsr::tasks
