#include "pipeline/color/track/object_view.h"

#include <algorithm>

namespace cgsr::color {

ObjectView view_object(const imaging::Pyramid& image, const Box& box) {
  constexpr double kMargin = 0.1;
  const Box inner{box.x + kMargin * box.width, box.y + kMargin * box.height, box.width * (1.0 - 2.0 * kMargin),
                  box.height * (1.0 - 2.0 * kMargin)};
  ObjectView view;
  image.sample_luma(inner, ObjectView::kSize, view.y);
  image.sample_chroma(inner, ObjectView::kSize, view.u, view.v);
  return view;
}

ObjectView relit(const ObjectView& view, const Light& gain) {
  const auto byte_of = [](double value) { return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)); };
  ObjectView changed;
  for (std::size_t i = 0; i < view.y.size(); ++i) {
    const auto rgb = lit(imaging::rgb_of_yuv(view.y[i], view.u[i], view.v[i]), gain);
    const auto yuv = imaging::yuv_of_rgb({std::min(1.0, rgb.r), std::min(1.0, rgb.g), std::min(1.0, rgb.b)});
    changed.y[i] = byte_of(yuv.y);
    changed.u[i] = byte_of(yuv.u);
    changed.v[i] = byte_of(yuv.v);
  }
  return changed;
}

}  // namespace cgsr::color
