#include "pipeline/localization/perceive.h"

#include <algorithm>

namespace cgsr::localization {
namespace {

constexpr int kHalvedFrom = 400;           // shorter side, px: below, halving would cost more edges than it saves work
constexpr std::size_t kLeastSegments = 2;  // a bare wall has its skirting

// Means of 2x2 lumas, rounded half up; kStep: bytes from one luma to the next. Both loops become vector instructions.
template <int kStep>
void halve(const ImageView& image, int width, int height, std::uint8_t* out) {
  for (int y = 0; y < height; ++y, out += width) {
    const std::uint8_t* upper = image.row(2 * y);
    const std::uint8_t* lower = image.row(2 * y + 1);
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* a = upper + 2 * kStep * x;
      const std::uint8_t* b = lower + 2 * kStep * x;
      out[x] = static_cast<std::uint8_t>((a[0] + a[kStep] + b[0] + b[kStep] + 2) >> 2);
    }
  }
}

}  // namespace

geometry::Camera working_camera(const geometry::Camera& camera) {
  if (std::min(camera.width_px, camera.height_px) < kHalvedFrom) return camera;
  // An odd last row or column is left out: the rest must not be stretched for it.
  geometry::Camera even = camera;
  even.width_px -= camera.width_px % 2;
  even.height_px -= camera.height_px % 2;
  return even.scaled_to(even.width_px / 2, even.height_px / 2);
}

Perception::Perception(const geometry::Camera& camera)
    : full_(camera),
      working_(working_camera(camera)),
      plain_(working_.without_distortion()),
      grey_(static_cast<std::size_t>(working_.width_px) * static_cast<std::size_t>(working_.height_px)),
      finder_(imaging::SegmentParameters{}, working_.width_px, working_.height_px),
      table_(kMostSegments) {}

bool Perception::make_grey(const ImageView& image) {
  if (image.empty() || (image.format != PixelFormat::kGrey8 && image.format != PixelFormat::kYuyv)) return false;
  const int step = image.format == PixelFormat::kYuyv ? 2 : 1;
  if (image.width_px == working_.width_px && image.height_px == working_.height_px) {
    if (step == 1) {
      plane_ = image.data;
      stride_ = image.stride_bytes;
      return true;
    }
    std::uint8_t* out = grey_.data();
    for (int y = 0; y < image.height_px; ++y)
      for (int x = 0; x < image.width_px; ++x) *out++ = image.row(y)[2 * x];
  } else if (image.width_px == full_.width_px && image.height_px == full_.height_px) {
    if (step == 2) {
      halve<2>(image, working_.width_px, working_.height_px, grey_.data());
    } else {
      halve<1>(image, working_.width_px, working_.height_px, grey_.data());
    }
  } else {
    return false;
  }
  plane_ = grey_.data();
  stride_ = working_.width_px;
  return true;
}

Reason Perception::cause_of_few() const {
  int dark = 0;
  int bright = 0;
  int looked_at = 0;
  for (int y = 0; y < working_.height_px; y += 4) {
    for (int x = 0; x < working_.width_px; x += 4) {
      const int value = plane_[y * stride_ + x];
      dark += value < 32 ? 1 : 0;
      bright += value > 228 ? 1 : 0;
      ++looked_at;
    }
  }
  if (10 * dark > 9 * looked_at) return Reason::kTooDark;
  if (10 * bright > 7 * looked_at) return Reason::kTooBright;
  return Reason::kTooFewEdges;
}

Reason Perception::perceive(const ImageView& image, const std::uint8_t* mask) {
  table_.clear();
  table_.finish();
  if (!make_grey(image)) return Reason::kWrongSize;
  for (const imaging::Segment& segment : finder_.find(plane_, working_.width_px, working_.height_px, stride_, mask)) {
    const Eigen::Vector2f p0 = working_.undistorted(segment.p0.cast<double>()).cast<float>();
    const Eigen::Vector2f p1 = working_.undistorted(segment.p1.cast<double>()).cast<float>();
    const float length = (p1 - p0).norm();
    if (!(length > 1.0F)) continue;
    table_.add({.middle = 0.5F * (p0 + p1),
                .direction = (p1 - p0) / length,
                .half_length = 0.5F * length,
                .contrast = segment.contrast,
                .sigma_px = segment.sigma_px});
  }
  table_.finish();
  return table_.size() < kLeastSegments ? cause_of_few() : Reason::kNone;
}

}  // namespace cgsr::localization
