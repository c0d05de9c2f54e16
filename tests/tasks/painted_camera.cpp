#include "tests/tasks/painted_camera.h"

#include <stdexcept>

#include "pipeline/color/learn/learn.h"

namespace cgsr::tasks::testing {
namespace {

struct Yuv {
  std::uint8_t y, u, v;
};
constexpr Yuv kRed{82, 100, 220};
constexpr Yuv kBlue{60, 200, 105};

}  // namespace

PaintedCamera::PaintedCamera() {
  without_ = paint(nullptr);
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const Box box = patch(i);
    with_patch_[i] = paint(&box);
  }
}

Box PaintedCamera::patch(std::uint64_t number) {
  const auto place = static_cast<double>(number % kPlaces);
  return {40.0 + 10.0 * place, 80.0, 48.0, 64.0};
}

PaintedCamera::Pixels PaintedCamera::paint(const Box* patch) const {
  Pixels pixels(static_cast<std::size_t>(kWidth_px) * kHeight_px * 2);
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; x += 2) {
      const bool inside = patch != nullptr && x >= patch->x && x < patch->x + patch->width && y >= patch->y &&
                          y < patch->y + patch->height;
      const auto grain = static_cast<std::uint8_t>((x * 7 + y * 13) % 23);
      const Yuv ground{static_cast<std::uint8_t>(110 + grain), static_cast<std::uint8_t>(118 + grain / 4), 124};
      const Yuv color = !inside ? ground : y < patch->y + patch->height / 2 ? kRed : kBlue;
      const std::size_t at = (static_cast<std::size_t>(y) * kWidth_px + static_cast<std::size_t>(x)) * 2;
      pixels[at] = color.y;
      pixels[at + 1] = color.u;
      pixels[at + 2] = color.y;
      pixels[at + 3] = color.v;
    }
  }
  return pixels;
}

ImageLease PaintedCamera::image(std::uint64_t number, bool absent) {
  const Pixels& pixels = absent ? without_ : with_patch_[number % kPlaces];
  const ImageView view{pixels.data(), kWidth_px, kHeight_px, kWidth_px * 2, PixelFormat::kYuyv};
  return ImageLease(*this, 0, view, number, MonoTime{static_cast<std::int64_t>(number) * kPeriod});
}

color::ColorModel PaintedCamera::learn() {
  const auto first = image(0);
  const color::Sample sample{first.view(), patch(0)};
  auto learned = color::learn({&sample, 1}, {});
  if (!learned) throw std::runtime_error(learned.error().message);
  return learned->model;
}

}  // namespace cgsr::tasks::testing
