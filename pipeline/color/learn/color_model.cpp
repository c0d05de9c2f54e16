#include "pipeline/color/learn/color_model.h"

#include <cmath>
#include <initializer_list>
#include <numeric>

#include <fmt/format.h>

namespace cgsr::color {
namespace {

bool within(double low, double high, std::initializer_list<double> values) {
  for (const double value : values) {
    if (!(value >= low && value <= high)) return false;  // a NaN is not
  }
  return true;
}

bool is_box(const Box& box, double limit) {
  return within(-limit, limit, {box.x, box.y}) && within(1e-3, limit, {box.width, box.height});
}

std::string defect_of_rows(const char* name, const std::vector<std::uint16_t>& rows, std::size_t lights,
                           std::size_t bins) {
  if (rows.size() != lights * bins)
    return fmt::format("{} has {} counts, {} lights of {} bins need {}", name, rows.size(), lights, bins,
                       lights * bins);
  for (std::size_t light = 0; light < lights; ++light) {
    const auto* row = rows.data() + light * bins;
    const int sum = std::accumulate(row, row + bins, 0);
    if (sum != kHistogramMass)
      return fmt::format("{}: histogram {} sums to {}, not to {}", name, light, sum, kHistogramMass);
  }
  return {};
}

std::string defect_of_patch(const SamplePatch& patch) {
  const bool sized =
      within(16, kMaxPatchSide, {1.0 * patch.width_px, 1.0 * patch.height_px}) && patch.width_px % 2 == 0;
  if (!sized || patch.yuyv.size() != static_cast<std::size_t>(patch.width_px * patch.height_px * 2)) {
    return fmt::format("a sample patch of {}x{} pixels with {} bytes", patch.width_px, patch.height_px,
                       patch.yuyv.size());
  }
  const bool placed = is_box(patch.window, 4.0 * kMaxPatchSide) && within(1e-4, 1e2, {patch.scale_x, patch.scale_y}) &&
                      within(0.01, 1.0, {patch.light.r, patch.light.g, patch.light.b});
  return placed ? std::string{} : "a sample patch whose window, scale or light is out of range";
}

}  // namespace

std::string defect_of(const ColorModel& model) {
  if (model.bins.per_channel < 2 || model.bins.per_channel > 16)
    return fmt::format("{} bins per channel", model.bins.per_channel);
  if (model.lights.empty() || model.lights.size() > kMaxLights) return fmt::format("{} lights", model.lights.size());
  for (const auto& light : model.lights) {
    if (!within(0.01, 1.0, {light.r, light.g, light.b})) return "a light outside 0.01..1";
  }
  const auto bins = static_cast<std::size_t>(model.bins.count());
  if (auto defect = defect_of_rows("object", model.object, model.lights.size(), bins); !defect.empty()) return defect;
  if (!model.surroundings.empty()) {
    if (auto defect = defect_of_rows("surroundings", model.surroundings, model.lights.size(), bins); !defect.empty())
      return defect;
  }
  constexpr double kMaxSide = 1 << 14;
  if (!within(1.0, kMaxSide,
              {model.width_px, model.height_px, 1.0 * model.image_width_px, 1.0 * model.image_height_px})) {
    return "a window or image size out of range";
  }
  if (!is_box(model.object_box, kMaxSide)) return "an object box out of range";
  if (!within(0.0, 1.0, {model.distinctiveness})) return "a distinctiveness out of range";
  if (model.samples.size() > kMaxSamples) return fmt::format("{} samples", model.samples.size());
  for (const auto& patch : model.samples) {
    if (auto defect = defect_of_patch(patch); !defect.empty()) return defect;
  }
  return {};
}

}  // namespace cgsr::color
