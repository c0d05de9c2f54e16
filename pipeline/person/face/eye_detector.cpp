#include "pipeline/person/face/eye_detector.h"

#include <cstddef>
#include <utility>

#include "pipeline/person/face/cascade.h"
#include "pipeline/person/face/face_descriptor.h"

namespace cgsr::person {
namespace {

// The upper two thirds of the face, and some of the margin: the detector's box is up to a third too small or too large.
constexpr int kLeft_px = 20, kTop_px = 20, kWidth_px = kFaceCrop_px - 2 * kLeft_px, kHeight_px = kFaceCrop_px / 2;
constexpr CascadeSearch kEyes{.step = 1.1, .min_neighbors = 1, .min_px = 20, .max_px = 48};

}  // namespace

EyeDetector::EyeDetector(std::unique_ptr<Cascade> cascade) : cascade_(std::move(cascade)) {}
EyeDetector::EyeDetector(EyeDetector&&) noexcept = default;
EyeDetector& EyeDetector::operator=(EyeDetector&&) noexcept = default;
EyeDetector::~EyeDetector() = default;

Result<EyeDetector> EyeDetector::from_cascade(const std::string& cascade_xml) {
  auto cascade = Cascade::from_xml(cascade_xml, "haarcascade_eye.xml");
  if (!cascade) return tl::unexpected(cascade.error());
  return EyeDetector(std::make_unique<Cascade>(std::move(*cascade)));
}

bool EyeDetector::has_eye(const GreyPatch& crop) {
  if (crop.width_px != kFaceCrop_px || crop.height_px != kFaceCrop_px || crop.pixels.empty()) return false;
  GreyPatch upper{kWidth_px, kHeight_px, {}};
  upper.pixels.reserve(std::size_t{kWidth_px} * kHeight_px);
  for (int y = 0; y < kHeight_px; ++y) {
    const auto row = crop.pixels.begin() + std::ptrdiff_t{kTop_px + y} * kFaceCrop_px + kLeft_px;
    upper.pixels.insert(upper.pixels.end(), row, row + kWidth_px);
  }
  stretch_contrast(upper);
  return !cascade_->find(upper, kEyes).empty();
}

}  // namespace cgsr::person
