#pragma once

#include <filesystem>

#include "pipeline/person/face/face_detector.h"
#include "platform/error.h"

namespace cgsr::app {

/// Reads a face cascade. \return an error that names the file and Debian's package.
Result<person::FaceDetector> read_face_detector(const std::filesystem::path& cascade,
                                                const person::FaceDetectorParameters& parameters);

}  // namespace cgsr::app
