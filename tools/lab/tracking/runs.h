#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/error.h"
#include "tools/lab/box_tracker.h"
#include "tools/lab/film.h"
#include "tools/lab/trackers.h"
#include "tools/lab/tracking/run_cache.h"

namespace cgsr::lab {

/// From where a run starts: a box in an image, which is learned from.
struct RunStart {
  int image = 0;
  Box box;
};

/// What a tracker said of each image from the start on.
struct TrackedRun {
  std::vector<Sighting> sightings;  ///< the first one is the start itself.
  LearnedObject learned;
  std::string refused;  ///< why the object was not learned, in words: then it is found nowhere. Empty: it was learned.

  [[nodiscard]] Boxes boxes() const;
};

/// A film in memory with the hash under which runs over it are kept.
struct HashedFilm {
  Film film;
  std::string sha256;  ///< of the pixels of all its images.
};

/// \return the film with its hash; or the image that cannot be read.
Result<HashedFilm> hashed(Film film);

/// Runs a tracker over a film from a start to its end.
/// \return what it said; or the image that cannot be read. A box that is refused is an answer: not found.
Result<TrackedRun> run_tracker(BoxTracker& tracker, const Film& film, const RunStart& start);

/// The same; a peer's boxes come from the cache where they are kept, and are kept there.
Result<TrackedRun> run_or_recall(const NamedTracker& named, const config::Color& configuration, const HashedFilm& film,
                                 const RunStart& start, const RunCache& cache);

}  // namespace cgsr::lab
