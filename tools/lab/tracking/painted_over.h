#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

#include "platform/error.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

/// Images in which an object is painted over.
struct AbsentRange {
  int first = 0;
  int count = 0;
  [[nodiscard]] int end() const { return first + count; }
};

inline constexpr int kAbsentImages = 60;
inline constexpr int kAgainWithinImages = 15;  ///< within which the object is to be found again

/// \return the 60 images in the middle of a video; fewer where it is too short: at least ten images before them and 15 after them show it as
///         it was recorded, and it is visible in the first of those after them. Count 0: too short for any.
AbsentRange absent_range(const Boxes& truth);

/// How the object's pixels were filled.
struct PaintShares {
  double neighbours = 0.0;  ///< by the background that other images show
  double inpainted = 0.0;
};

/// The part of an image that is painted over: the true box with a margin for loose boxes and soft edges.
cv::Rect painted_region(const Box& box, const cv::Size& size);

/// Paints over what a box covers. The background comes from other images of the film, moved by the homography between their backgrounds
/// (corners followed by optical flow, RANSAC) and accepted where the surroundings of the box agree; nearest images first. What none of them
/// shows is inpainted (Telea, 2004).
///
/// \param number  of the image; its object is visible.
Result<cv::Mat> painted_over(const Film& film, int number, PaintShares* shares = nullptr);

/// The film with an object that is absent in a range. The images that differ are kept as PNG files in `folder`, and read from there where
/// they are already kept; an empty folder: they are kept nowhere.
Result<Film> film_without_object(const Film& film, const AbsentRange& range, const std::filesystem::path& folder);

}  // namespace cgsr::lab
