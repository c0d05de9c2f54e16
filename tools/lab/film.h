#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <opencv2/core/types.hpp>

#include "platform/error.h"
#include "tools/lab/image.h"
#include "tools/lab/scoring.h"

namespace cgsr::lab {

/// Images in order and what is true in them; the object is visible in image 0. Images are made when they are asked for.
struct Film {
  std::string name;
  std::function<Result<Image>(int)> image;
  Boxes truth;  ///< one entry per image

  [[nodiscard]] int size() const { return static_cast<int>(truth.size()); }
};

/// Opens FOLDER/img or FOLDER/images (image files in the order of their names) and FOLDER/groundtruth.txt or FOLDER/groundtruth_rect.txt
/// (read_truth()).
///
/// \param size  every image, and its truth, is scaled to this size; nothing: as recorded.
/// \return the film, or what is missing: the images, the truth, or a first image in which the object is visible.
Result<Film> open_film(const std::filesystem::path& folder, std::optional<cv::Size> size = std::nullopt);

/// A generated film (scenes/moving_scene.h). \param absent  the object is nowhere but in image 0.
Film generated_film(std::uint64_t seed, int images, bool absent = false);

/// Writes FOLDER/img/0000.png, … and FOLDER/groundtruth.txt, so that any tracker can be tried on it.
/// \return the file that cannot be written.
Result<void> save_film(const Film& film, const std::filesystem::path& folder);

}  // namespace cgsr::lab
