#include "pipeline/person/colors/part_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace cgsr::person {
namespace {

constexpr double kStrip = 0.5;        // width of the strip around a place, in its shorter side
constexpr double kLargestStep = 1.3;  // in sides, of the reach after images without the part
constexpr int kCells = 24;            // of the shorter side, where a place is large

Box grown(const Box& box, double x, double y) {
  return {box.x - x, box.y - y, box.width + 2.0 * x, box.height + 2.0 * y};
}

Box moved(const Box& box, double dx, double dy, double scale) {
  const double width = scale * box.width, height = scale * box.height;
  return {box.x + dx + (box.width - width) / 2, box.y + dy + (box.height - height) / 2, width, height};
}

double strip_of(const Box& place) {
  return std::max(1.0, kStrip * std::min(place.width, place.height));
}

}  // namespace

void PartPlace::count(const LabelImage& image, std::uint16_t label, const Box& window) {
  left_ = std::max(0, static_cast<int>(window.x)), top_ = std::max(0, static_cast<int>(window.y));
  const int right = std::min(image.width_px, static_cast<int>(window.x + window.width));
  const int bottom = std::min(image.height_px, static_cast<int>(window.y + window.height));
  columns_ = std::max(0, right - left_) / cell_, rows_ = std::max(0, bottom - top_) / cell_;
  const std::size_t stride = static_cast<std::size_t>(columns_) + 1;
  counts_.assign(stride * (static_cast<std::size_t>(rows_) + 1), 0);
  for (int row = 0; row < rows_; ++row) {
    int* const below = counts_.data() + stride * (static_cast<std::size_t>(row) + 1);
    const int* const above = below - stride;
    int met = 0;
    for (int column = 0; column < columns_; ++column) {
      met += image.at(left_ + column * cell_, top_ + row * cell_) == label ? 1 : 0;
      below[column + 1] = above[column + 1] + met;
    }
  }
}

int PartPlace::sum(int left, int top, int right, int bottom) const {
  const auto at = [this](int column, int row) {
    return counts_[static_cast<std::size_t>(row) * (static_cast<std::size_t>(columns_) + 1) +
                   static_cast<std::size_t>(column)];
  };
  return at(right, bottom) - at(left, bottom) - at(right, top) + at(left, top);
}

// What is outside of the image has none of the colours inside a place, and does not count around it.
PartPlace::Fill PartPlace::fill(const Box& place) const {
  const double strip = strip_of(place);
  const auto column = [this](double x) { return static_cast<int>(std::lround((x - left_) / cell_)); };
  const auto row = [this](double y) { return static_cast<int>(std::lround((y - top_) / cell_)); };
  const auto in_columns = [this](int x) { return std::clamp(x, 0, columns_); };
  const auto in_rows = [this](int y) { return std::clamp(y, 0, rows_); };
  const int x0 = column(place.x), x1 = column(place.x + place.width);
  const int y0 = row(place.y), y1 = row(place.y + place.height);
  const int l = in_columns(x0), r = in_columns(x1), t = in_rows(y0), b = in_rows(y1);
  const int around_l = in_columns(column(place.x - strip)),
            around_r = in_columns(column(place.x + place.width + strip));
  const int around_t = in_rows(row(place.y - strip)), around_b = in_rows(row(place.y + place.height + strip));
  const int met = sum(l, t, r, b), met_around = sum(around_l, around_t, around_r, around_b) - met;
  const int cells = std::max(1, (x1 - x0) * (y1 - y0));
  const int cells_around = std::max(1, (around_r - around_l) * (around_b - around_t) - (r - l) * (b - t));
  const double inside = double(met) / cells;
  return {inside, inside - double(met_around) / cells_around};
}

void PartPlace::begin(const LabelImage& image, std::uint16_t label, const Box& place) {
  place_.reset();
  if (!parameters_.enabled || image.empty() || place.empty()) return;
  cell_ = std::max(1, static_cast<int>(std::min(place.width, place.height) / kCells));
  count(image, label, grown(place, strip_of(place), strip_of(place)));
  const Fill now = fill(place);
  place_ = place;
  first_width_ = place.width;
  usual_ = now;
  contrast_ = now.contrast;
  lost_ = 0;
}

std::optional<Box> PartPlace::follow(const LabelImage& image, std::uint16_t label) {
  constexpr double kFar = 0.1;                 // what a step of its own size costs, in contrast
  constexpr double kResized = 0.03;            // what another size costs: it changes slowly
  constexpr double kUsual = 0.05;              // share of an image in what is usual
  constexpr double kFollows = 0.2;             // share of a change of size that is followed in an image
  constexpr double kGrows = 0.3;               // of the reach, with each image without it
  constexpr double kLeast = 0.5, kMost = 2.0;  // of the first width
  constexpr int kSteps = 12;                   // to each side, at most: what a search costs is bounded
  constexpr std::array kScales{1.0, 0.95, 1.05};
  if (!place_ || image.empty()) return std::nullopt;
  const double side = std::sqrt(place_->area());
  const double reach = std::min(kLargestStep, parameters_.reach * (1.0 + kGrows * lost_)) * side;
  const double margin = reach + 1.1 * strip_of(*place_) + 0.05 * side;
  cell_ = std::max(1, static_cast<int>(std::min(place_->width, place_->height) / kCells));
  count(image, label, grown(*place_, margin, margin));
  const int steps = std::min(kSteps, static_cast<int>(reach / cell_));
  const double step = reach / std::max(1, steps);
  double best = -2.0, best_scale = 1.0;
  Box found = *place_;
  for (const double scale : kScales) {
    const double width = scale * place_->width;
    if (width < kLeast * first_width_ || width > kMost * first_width_) continue;
    for (int row = -steps; row <= steps; ++row) {
      for (int column = -steps; column <= steps; ++column) {
        const double dx = column * step, dy = row * step;
        const double cost = kFar * (dx * dx + dy * dy) / place_->area() + (scale != 1.0 ? kResized : 0.0);
        const double merit = fill(moved(*place_, dx, dy, scale)).contrast - cost;
        if (merit <= best) continue;
        best = merit, best_scale = scale;
        found = moved(*place_, dx, dy, 1.0);
      }
    }
  }
  const Fill now = fill(found);
  const double share = parameters_.min_of_usual;
  const bool covered = now.inside < share * usual_.inside || now.contrast < share * usual_.contrast;
  if (covered || now.contrast < parameters_.min_contrast) {
    if (++lost_ > parameters_.max_lost) end();
    return std::nullopt;
  }
  lost_ = 0;
  contrast_ = now.contrast;
  usual_.inside += kUsual * (now.inside - usual_.inside);
  usual_.contrast += kUsual * (now.contrast - usual_.contrast);
  place_ = moved(found, 0.0, 0.0, 1.0 + kFollows * (best_scale - 1.0));
  return place_;
}

}  // namespace cgsr::person
