#include "tools/lab/tracking/runs.h"

#include <utility>

#include <fmt/format.h>
#include <opencv2/core/version.hpp>

#include "platform/config/sha256.h"

namespace cgsr::lab {
namespace {

/// All that a peer's boxes depend on.
std::string key_of(const NamedTracker& named, const HashedFilm& film, const RunStart& start) {
  return config::sha256(fmt::format("{} {}, OpenCV {}, {} images {}, from {} {:.4f} {:.4f} {:.4f} {:.4f}", named.name,
                                    named.options, CV_VERSION, film.film.size(), film.sha256, start.image, start.box.x,
                                    start.box.y, start.box.width, start.box.height));
}

TrackedRun run_of(const Boxes& boxes) {
  TrackedRun run;
  run.sightings.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    run.sightings[i].box = boxes[i];
    run.sightings[i].confidence = boxes[i] ? 1.0 : 0.0;
  }
  if (!boxes.empty() && !boxes.front()) run.refused = "refused to learn the object";
  return run;
}

}  // namespace

Boxes TrackedRun::boxes() const {
  Boxes boxes;
  boxes.reserve(sightings.size());
  for (const Sighting& sighting : sightings) boxes.push_back(sighting.box);
  return boxes;
}

Result<HashedFilm> hashed(Film film) {
  config::Sha256 sum;
  for (int i = 0; i < film.size(); ++i) {
    const auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    const cv::Mat& bgr = image->bgr;
    const std::string size = fmt::format("{}x{}", bgr.cols, bgr.rows);
    sum.add(size.data(), size.size());
    for (int y = 0; y < bgr.rows; ++y) sum.add(bgr.ptr(y), static_cast<std::size_t>(bgr.cols) * bgr.elemSize());
  }
  return HashedFilm{std::move(film), sum.hex()};
}

Result<TrackedRun> run_tracker(BoxTracker& tracker, const Film& film, const RunStart& start) {
  TrackedRun run;
  run.sightings.resize(static_cast<std::size_t>(film.size() - start.image));
  const auto first = film.image(start.image);
  if (!first) return tl::unexpected(first.error());
  const auto learned = tracker.learn(*first, start.box);
  if (!learned) {
    run.refused = learned.error().message;
    return run;
  }
  run.learned = *learned;
  run.sightings.front() = {start.box, learned->light, learned->light, 0.0, 1.0};
  for (std::size_t i = 1; i < run.sightings.size(); ++i) {
    const auto image = film.image(start.image + static_cast<int>(i));
    if (!image) return tl::unexpected(image.error());
    run.sightings[i] = tracker.track(*image);
  }
  return run;
}

Result<TrackedRun> run_or_recall(const NamedTracker& named, const config::Color& configuration, const HashedFilm& film,
                                 const RunStart& start, const RunCache& cache) {
  const bool is_kept = !named.options.empty();
  const std::string key = is_kept ? key_of(named, film, start) : "";
  if (is_kept) {
    const auto boxes = cache.find(key, static_cast<std::size_t>(film.film.size() - start.image));
    if (boxes) return run_of(*boxes);
  }
  auto run = run_tracker(*named.make(configuration), film.film, start);
  if (run && is_kept) cache.keep(key, run->boxes());
  return run;
}

}  // namespace cgsr::lab
