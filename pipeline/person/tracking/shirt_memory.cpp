#include "pipeline/person/tracking/shirt_memory.h"

#include <cmath>

#include "pipeline/person/colors/part_light.h"
#include "pipeline/person/colors/person_colors.h"

namespace cgsr::person {

void ShirtMemory::see(const ImageView& image, const Box& face) {
  const auto color = mean_color(image, sampling_regions(face).shirt);
  if (!color) return;
  const double r = color->r, g = color->g, b = color->b;
  const double sum = r + g + b;
  if (!(sum > 0.0)) return;
  now_.r += r / sum;
  now_.g += g / sum;
  ++now_.images;
}

void ShirtMemory::begin_anew() {
  if (now_.images >= images_needed_) before_ = now_;
  now_ = {};
}

std::optional<double> ShirtMemory::change() const {
  if (before_.images < images_needed_ || now_.images < images_needed_) return std::nullopt;
  return std::hypot(now_.r / now_.images - before_.r / before_.images,
                    now_.g / now_.images - before_.g / before_.images);
}

}  // namespace cgsr::person
