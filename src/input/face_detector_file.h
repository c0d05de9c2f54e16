#pragma once

#include <filesystem>
#include <optional>

#include "pipeline/person/face/eye_detector.h"
#include "pipeline/person/face/face_detector.h"
#include "platform/error.h"

namespace cgsr::app {

/// Reads a face cascade. \return an error that names the file and Debian's package.
Result<person::FaceDetector> read_face_detector(const std::filesystem::path& cascade,
                                                const person::FaceDetectorParameters& parameters);

/// Reads an eye cascade. \return nothing: the path is empty; an error that names the file and Debian's package.
Result<std::optional<person::EyeDetector>> read_eye_detector(const std::filesystem::path& cascade);

}  // namespace cgsr::app
