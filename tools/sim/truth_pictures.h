#pragma once

#include <filesystem>

#include <opencv2/core/mat.hpp>

#include "hal/sim/truth.h"
#include "platform/error.h"

namespace cgsr::sim {

/// \return what is wrong with a path that a PNG is to be written to.
Result<void> check_picture_path(const std::filesystem::path& path);

/// Writes a PNG. \return why it could not be.
Result<void> write_picture(const std::filesystem::path& path, const cv::Mat& picture);

/// Writes a text file. \return why it could not be.
Result<void> write_text(const std::filesystem::path& path, const std::string& text);

/// A camera's YUYV, two bytes a pixel, as colours that a PNG holds.
cv::Mat as_bgr(const cv::Mat& yuyv);

/// What is there, beside an image that the renderer has just drawn: truth.csv, depth.png, parts.png with parts.csv, and the masks when there
/// are any. The folder is made.
Result<void> write_truth_pictures(const Renderer& renderer, const Truth& truth, const TruthOptions& options,
                                  const std::filesystem::path& folder);

}  // namespace cgsr::sim
