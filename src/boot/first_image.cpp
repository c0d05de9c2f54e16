#include "src/boot/first_image.h"

#include <utility>

#include <fmt/format.h>

namespace cgsr::boot {

Result<ImageLease> first_good_image(hal::Camera& camera, const std::function<std::optional<MonoTime>()>& next_try) {
  int damaged = 0;
  while (const auto give_up_at = next_try()) {
    auto image = camera.next_image(*give_up_at);
    if (image) return std::move(*image);
    if (image.error() == hal::CaptureFailure::kCorrupt) ++damaged;
    if (image.error() == hal::CaptureFailure::kDisconnected || image.error() == hal::CaptureFailure::kEndOfStream)
      break;
  }
  const std::string problem = camera.last_problem();
  return fail(fmt::format("no first image{}{}{}", damaged > 0 ? fmt::format(" but {} damaged", damaged) : "",
                          problem.empty() ? "" : ": ", problem));
}

}  // namespace cgsr::boot
