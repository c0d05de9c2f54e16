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

}  // namespace cgsr::app
