#include "tools/lab/trackers.h"

#include <algorithm>

#include "platform/count_marks.h"
#include "tools/lab/ours.h"
#include "tools/lab/peers.h"

namespace cgsr::lab {

std::span<const NamedTracker> trackers() {
  static constexpr std::array kTrackers{
      NamedTracker{"ours", [](const config::Color& configuration) { return make_ours(configuration); }, ""},
      NamedTracker{"plain", [](const config::Color& configuration) { return make_plain(configuration); }, ""},
      NamedTracker{"CAM-Shift", [](const config::Color&) { return make_cam_shift(); }, kCamShiftOptions},
      NamedTracker{"KCF", [](const config::Color&) { return make_kcf(); }, kKcfOptions},
      NamedTracker{"CSRT", [](const config::Color&) { return make_csrt(); }, kCsrtOptions},
  };
  return kTrackers;
}

Result<Boxes> follow(BoxTracker& tracker, const Film& film, int images, const Film& learn_from) {
  const auto first = learn_from.image(0);
  if (!first) return tl::unexpected(first.error());
  if (auto learned = tracker.learn(*first, *learn_from.truth.front()); !learned) return tl::unexpected(learned.error());
  Boxes boxes{learn_from.truth.front()};
  for (int i = 1; i < std::min(images, film.size()); ++i) {
    const auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    boxes.push_back(tracker.track(*image).box);
    count_image_end();
  }
  return boxes;
}

}  // namespace cgsr::lab
