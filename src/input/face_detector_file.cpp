#include "src/input/face_detector_file.h"

#include <fmt/format.h>

#include "src/input/small_file.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kMaxCascadeBytes = std::size_t{16} << 20U;

}  // namespace

Result<person::FaceDetector> read_face_detector(const std::filesystem::path& cascade,
                                                const person::FaceDetectorParameters& parameters) {
  const auto text = read_small_file(cascade, kMaxCascadeBytes, "a face cascade");
  if (!text)
    return fail(text.error().message +
                "; Debian's opencv-data has one: --cascade or person.cascade names another place");
  auto detector = person::FaceDetector::from_cascade(*text, parameters);
  if (!detector) return fail(fmt::format("{}: {}", cascade.string(), detector.error().message));
  return detector;
}

Result<std::optional<person::EyeDetector>> read_eye_detector(const std::filesystem::path& cascade) {
  if (cascade.empty()) return std::nullopt;
  const auto text = read_small_file(cascade, kMaxCascadeBytes, "an eye cascade");
  if (!text)
    return fail(
        text.error().message +
        "; Debian's opencv-data has one: --eye-cascade or person.eye_cascade names another place, or none (\"\")");
  auto detector = person::EyeDetector::from_cascade(*text);
  if (!detector) return fail(fmt::format("{}: {}", cascade.string(), detector.error().message));
  return std::optional(std::move(*detector));
}

}  // namespace cgsr::app
