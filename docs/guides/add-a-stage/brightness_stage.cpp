#include "docs/guides/add-a-stage/brightness_stage.h"

#include <numeric>

namespace cgsr::stages {
namespace {

constexpr double kBlack = 16.0;  // BT.601 limited range
constexpr double kWhite = 235.0;

}  // namespace

Brightness BrightnessStage::update(const runtime::Aged<View>& view) {
  if (!view.fresh() || !view.value.reduced) return {};
  const ImageView grey = view.value.grey();
  double sum = 0.0;
  for (int y = 0; y < grey.height_px; ++y) sum += std::accumulate(grey.row(y), grey.row(y) + grey.width_px, 0);
  const double mean = sum / (static_cast<double>(grey.width_px) * grey.height_px);
  return {true, (mean - kBlack) / (kWhite - kBlack)};
}

}  // namespace cgsr::stages
