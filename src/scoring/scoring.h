#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "platform/box.h"
#include "platform/error.h"

namespace cgsr::app {

/// One entry per image; empty where the object is not visible (truth) or not found (track).
using Boxes = std::vector<std::optional<Box>>;

/// How one detected box B meets the true box A of the same image; all zero where nothing was found.
struct ImageScore {
  double precision = 0.0;  ///< |A and B| / |B|   (Eq. 3.2)
  double recall = 0.0;     ///< |A and B| / |A|
  double iou = 0.0;        ///< |A and B| / |A or B|
  bool success = false;    ///< iou > 0.5
  bool found = false;
};

/// Means over the images in which the object is visible.
struct Score {
  double precision = 0.0;
  double recall = 0.0;
  double iou = 0.0;
  double success = 0.0;       ///< share of images with IoU > 0.5
  double found = 0.0;         ///< share of images in which a box was given
  int images = 0;             ///< images in which the object is visible
  int found_when_absent = 0;  ///< boxes given in images in which it is not
};

ImageScore score_image(const Box& truth, const std::optional<Box>& found);

/// \return a score for each image from `skip_first` on in which the object is visible, in order.
std::vector<ImageScore> score_images(const Boxes& track, const Boxes& truth, int skip_first = 0);

/// Scores a track against the truth. A track shorter than the truth counts as not found in the rest; a longer one is cut.
Score score(const Boxes& track, const Boxes& truth, int skip_first = 0);

/// Reads a truth file: a line per image, x,y,width,height or a polygon x1,y1,x2,y2,… of at least four points (its upright
/// bounding box counts), split by commas, semicolons, tabs or blanks. A line that is blank, holds a NaN or a box without
/// area means: not visible.
///
/// \return the boxes, or the file that cannot be read, the line that is anything else, or that there is no line.
Result<Boxes> read_truth(const std::filesystem::path& path);

/// \return an error unless the truth has a line for each of so many images. Further lines in which nothing is visible do no harm.
Result<void> check_length(const std::filesystem::path& path, const Boxes& truth, std::size_t images);

/// Reads a track CSV: frame,found,x,y,width,height[,…]. Rows whose frame is not a number (the header) are skipped, images
/// without a row, with found <= 0, a NaN or a box without area count as not found.
///
/// \return the boxes, as long as the last image named demands, or the file that cannot be read.
Result<Boxes> read_track(const std::filesystem::path& path);

}  // namespace cgsr::app
