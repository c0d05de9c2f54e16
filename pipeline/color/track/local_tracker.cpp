#include "pipeline/color/track/local_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/color/track/orientation_histograms.h"

namespace cgsr::color {
namespace {

constexpr int kShapeCell_px = 2;
constexpr double kLeastInner = 0.3;  // of the box's side, however thin the box is
/// A plane of 64x64 bytes as a channel of 32x32 cells: 2x2 means, without the mean of all, in units of 128 / gain grey levels.
void to_channel(std::span<const std::uint8_t> bytes, float gain, RealGrid& channel) {
  constexpr std::size_t kRow = 2 * kGrid;
  int total = 0;
  std::array<int, kGridArea> sums;
  for (std::size_t y = 0; y < kGrid; ++y) {
    const std::uint8_t* top = bytes.data() + 2 * y * kRow;
    const std::uint8_t* bottom = top + kRow;
    for (std::size_t x = 0; x < kGrid; ++x) {
      const int sum = top[2 * x] + top[2 * x + 1] + bottom[2 * x] + bottom[2 * x + 1];
      sums[y * kGrid + x] = sum;
      total += sum;
    }
  }
  const float mean = static_cast<float>(total) / kGridArea;
  for (std::size_t i = 0; i < kGridArea; ++i)
    channel[i] = (static_cast<float>(sums[i]) - mean) * gain / (4.0F * 128.0F);
}

}  // namespace

LocalTracker::LocalTracker(const LocalParameters& parameters)
    : parameters_(parameters),
      shape_(parameters.correlation),
      scale_(parameters.scale),
      patch_({kPatch_px, kPatch_px}),
      integral_(static_cast<std::size_t>(kPatch_px + 1) * (kPatch_px + 1)) {}

Box LocalTracker::region_of(const Box& box) const {
  const double width = box.width * reach_x_;
  const double height = box.height * reach_y_;
  return {box.x + 0.5 * (box.width - width), box.y + 0.5 * (box.height - height), width, height};
}

/// The box in pixels of the colour patch, each side shorter by `margin` mean sides.
Box LocalTracker::object_in_patch(double margin) const {
  const double width = kPatch_px / reach_x_;
  const double height = kPatch_px / reach_y_;
  const double cut = margin * 0.5 * (width + height);
  const double inner_width = std::max(kLeastInner * width, width - cut);
  const double inner_height = std::max(kLeastInner * height, height - cut);
  return {0.5 * (kPatch_px - inner_width), 0.5 * (kPatch_px - inner_height), inner_width, inner_height};
}

/// The same in the patch around `taken` for an object that is at `box`.
Box LocalTracker::object_in_patch(double margin, const Box& box, const Box& taken) const {
  Box object = object_in_patch(margin);
  const Displacement moved = displacement(box, taken);
  object.x += moved.x * kPatch_px / kGrid;
  object.y += moved.y * kPatch_px / kGrid;
  return object;
}

/// How far the centre of `box` is from that of `taken`, in cells of the patch around the latter.
LocalTracker::Displacement LocalTracker::displacement(const Box& box, const Box& taken) const {
  const Box region = region_of(taken);
  return {(box.x + 0.5 * box.width - taken.x - 0.5 * taken.width) * kGrid / region.width,
          (box.y + 0.5 * box.height - taken.y - 0.5 * taken.height) * kGrid / region.height};
}

/// Whether the patch at hand shows `box` nearly in its middle, in its size and under this light, so that no other needs to be taken.
bool LocalTracker::patch_shows(const imaging::Pyramid& image, const Box& box, const Light& light) const {
  constexpr double kMaxMovedCells = 2.0;  // the window still weighs more than 0.9 there
  constexpr double kMostGrowth = 0.02;    // less than a step of the scales
  constexpr double kMostGain = 0.02;
  if (taken_build_ != image.builds()) return false;
  const Displacement moved = displacement(box, taken_);
  const Light change = without_light(light, taken_light_);
  return std::max(std::abs(moved.x), std::abs(moved.y)) <= kMaxMovedCells &&
         std::abs(box.width / taken_.width - 1.0) <= kMostGrowth &&
         std::max({std::abs(change.r - 1.0), std::abs(change.g - 1.0), std::abs(change.b - 1.0)}) <= kMostGain;
}

void LocalTracker::take_patch(const imaging::Pyramid& image, const Box& box, const Light& light) {
  const Box region = region_of(box);
  image.sample_luma(region, patch_.size, patch_.y);
  image.sample_chroma(region, patch_.size, patch_.u, patch_.v);
  relight(patch_, inverse(light));
  taken_ = box;
  taken_light_ = light;
  taken_build_ = image.builds();
}

void LocalTracker::take_features(const ColorPatch& patch) {
  std::array<float, std::size_t{kOrientations} * kGridArea> orientations;
  orientation_histograms(patch.y, patch.size, kShapeCell_px, orientations);
  for (std::size_t k = 0; k < kOrientations; ++k) {
    std::copy_n(orientations.begin() + static_cast<std::ptrdiff_t>(k * kGridArea), kGridArea, features_[k].begin());
  }
  to_channel(patch.y, 1.0F, features_[9]);
  to_channel(patch.u, 2.0F, features_[10]);
  to_channel(patch.v, 2.0F, features_[11]);
}

void LocalTracker::begin(const imaging::Pyramid& image, const Box& box) {
  const double around = 0.5 * (box.width + box.height) * parameters_.padding;
  reach_x_ = (box.width + around) / box.width;
  reach_y_ = (box.height + around) / box.height;
  take_patch(image, box, {1.0, 1.0, 1.0});
  take_features(patch_);
  shape_.begin(features_, kGrid / reach_x_, kGrid / reach_y_);
  scale_.begin(image, box);
  colors_.learn(patch_, object_in_patch(parameters_.inner_margin), object_in_patch(0.0), 1.0);
  learned_colors_ = colors_;
}

void LocalTracker::learn(const imaging::Pyramid& image, const Box& box, const Light& light) {
  if (patch_shows(image, box, light)) {
    const Displacement moved = displacement(box, taken_);
    shape_.learn_last(moved.x, moved.y);
  } else {
    take_patch(image, box, light);
    take_features(patch_);
    shape_.learn(features_);
  }
  colors_.learn(patch_, object_in_patch(parameters_.inner_margin, box, taken_), object_in_patch(0.0, box, taken_),
                parameters_.color_rate);
  scale_.learn(image, box);
}

LocalAnswer LocalTracker::look(const imaging::Pyramid& image, const Box& box, const Light& light, Colors colors) {
  take_patch(image, box, light);
  take_features(patch_);
  RealGrid shape;
  shape_.respond(features_, shape);
  RealGrid color;
  score_colors(colors == Colors::kFirst ? learned_colors_ : colors_, color);
  const auto color_share = static_cast<float>(parameters_.color_share);
  RealGrid merged;
  for (std::size_t i = 0; i < kGridArea; ++i) merged[i] = (1.0F - color_share) * shape[i] + color_share * color[i];

  const Peak peak = peak_of(merged);
  LocalAnswer answer;
  answer.box = box;
  answer.score = peak.value;
  answer.sharpness = peak_of(shape).sharpness;
  answer.box.x += (peak.x - 0.5 * kGrid) * box.width * reach_x_ / kGrid;
  answer.box.y += (peak.y - 0.5 * kGrid) * box.height * reach_y_ / kGrid;
  measure_colors(color[static_cast<std::size_t>(std::lround(peak.y) * kGrid + std::lround(peak.x))], answer);
  return answer;
}

/// How well the colours tell the object from what is around it. \param score  of score_colors where the object is.
void LocalTracker::measure_colors(double score, LocalAnswer& answer) const {
  const double all = integral_.back();
  const double inside = score * kPatch_px / reach_x_ * kPatch_px / reach_y_;
  const double around_px = kPatch_px * kPatch_px * (1.0 - 1.0 / (reach_x_ * reach_y_));
  answer.color_inside = score;
  answer.color_around = std::max(0.0, all - inside) / around_px;
}

/// The mean likelihood of the box's pixels, for every cell its centre may move to.
void LocalTracker::score_colors(const ColorLikelihood& colors, RealGrid& score) {
  constexpr int kRow = kPatch_px + 1;
  std::size_t at = 0;
  for (int y = 0; y < kPatch_px; ++y) {
    const float* above = integral_.data() + y * kRow;
    float* sums = integral_.data() + (y + 1) * kRow;
    float row = 0.0F;
    for (int x = 0; x < kPatch_px; ++x, ++at) {
      row += colors.of(patch_.y[at], patch_.u[at], patch_.v[at]);
      sums[x + 1] = above[x + 1] + row;
    }
  }
  const double width = kPatch_px / reach_x_;
  const double height = kPatch_px / reach_y_;
  const auto inverse_area = static_cast<float>(1.0 / (width * height));
  const auto edges = [](double length) {
    std::array<std::pair<int, int>, kGrid> spans;
    for (int i = 0; i < kGrid; ++i) {
      const double centre = static_cast<double>(kPatch_px) / kGrid * i;
      const auto bound = [](double edge) { return std::clamp(static_cast<int>(std::lround(edge)), 0, kPatch_px); };
      spans[static_cast<std::size_t>(i)] = {bound(centre - 0.5 * length), bound(centre + 0.5 * length)};
    }
    return spans;
  };
  const auto columns = edges(width);
  const auto rows = edges(height);
  for (std::size_t j = 0; j < kGrid; ++j) {
    const float* top = integral_.data() + rows[j].first * kRow;
    const float* bottom = integral_.data() + rows[j].second * kRow;
    for (std::size_t i = 0; i < kGrid; ++i) {
      const auto [left, right] = columns[i];
      score[j * kGrid + i] = (bottom[right] - bottom[left] - top[right] + top[left]) * inverse_area;
    }
  }
}

}  // namespace cgsr::color
