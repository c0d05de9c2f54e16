#include "pipeline/color/track/object_view.h"

#include "pipeline/color/track/relight.h"

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

ObjectView view_image(const imaging::Pyramid& image) {
  const Box whole{0.0, 0.0, static_cast<double>(image.width_px()), static_cast<double>(image.height_px())};
  ObjectView view;
  image.sample_luma(whole, ObjectView::kSize, view.y);
  image.sample_chroma(whole, ObjectView::kSize, view.u, view.v);
  return view;
}

ObjectView relit(const ObjectView& view, const Light& gain) {
  ObjectView changed = view;
  relight(changed.y, changed.u, changed.v, gain);
  return changed;
}

}  // namespace cgsr::color
