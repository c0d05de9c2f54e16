#include "pipeline/stages/decode_stage.h"

#include <utility>

namespace cgsr::stages {
namespace {

constexpr std::size_t kImages = 3;  // one that is written, the last one, and one that a test or a drawing holds

imaging::LabelTable table_or_zeros(imaging::LabelTable labels) {
  if (labels.empty()) labels.assign(imaging::kColorCodes, 0);
  return labels;
}

}  // namespace

ImageView View::grey() const {
  return {reduced->grey.data(), reduced->width_px, reduced->height_px, reduced->width_px, PixelFormat::kGrey8};
}

DecodeStage::DecodeStage(Setup setup)
    : labels_(table_or_zeros(std::move(setup.labels))),
      object_shorter_side_px_(setup.object_shorter_side_px),
      images_(kImages, imaging::ReducedImage(setup.max_width_px, setup.max_height_px)) {}

View DecodeStage::update(const ImageView& image) {
  View view;
  const int factor =
      imaging::reduction_for(image.width_px, image.height_px, object_shorter_side_px_.value_or(image.width_px));
  auto reduced = images_.take();
  if (reduced && imaging::reduce(image, factor, labels_, reduced.edit())) view.reduced = std::move(reduced);
  return view;
}

}  // namespace cgsr::stages
