#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "platform/error.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

/// A picture file of the page, and what it shows.
struct FailurePicture {
  std::string file;  ///< relative to the page
  std::string caption;
};

/// What the page shows of a sequence.
struct SequencePictures {
  std::string sequence;
  std::string film;  ///< relative to the page
  std::vector<FailurePicture> failures;
};

/// A tracker's boxes over a film, for drawing.
struct NamedTrack {
  std::string_view name;
  Boxes boxes;
};

/// Writes FOLDER/films/NAME.mp4, with the truth in white and each tracker in its colour, and FOLDER/failures/NAME-IMAGE.jpg of the first
/// image of each loss.
///
/// \param losses  images of the first tracker's losses; the first eight are kept.
/// \return what was written; or which file cannot be.
Result<SequencePictures> write_pictures(const Film& film, const std::vector<NamedTrack>& tracks,
                                        const std::vector<int>& losses, const std::filesystem::path& folder);

}  // namespace cgsr::lab
