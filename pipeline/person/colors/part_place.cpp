#include "pipeline/person/colors/part_place.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cgsr::person {
namespace {

constexpr double kStrip = 0.5;                     // width of the strip around a place, in its shorter side
constexpr double kLargestStep = 1.3;               // in sides, of the reach after images without the part
constexpr double kSmallest = 0.5, kLargest = 3.0;  // of the first width
constexpr int kCells = 24;                         // of the shorter side, where a place is large
constexpr int kSteps = 16;                         // to each side of a search, at most: its cost is bounded

Box grown(const Box& box, double x, double y) {
  return {box.x - x, box.y - y, box.width + 2.0 * x, box.height + 2.0 * y};
}

Box moved(const Box& box, double dx, double dy, double scale) {
  const double width = scale * box.width, height = scale * box.height;
  return {box.x + dx + (box.width - width) / 2, box.y + dy + (box.height - height) / 2, width, height};
}

int cell_for(const Box& place, double reach) {
  const double side = std::min(place.width, place.height);
  return std::max({1, static_cast<int>(side / kCells), static_cast<int>(std::ceil(reach / kSteps))});
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
    const std::uint16_t* const labels = image.row(top_ + row * cell_) + left_;
    int met = 0;
    for (int column = 0; column < columns_; ++column) {
      met += (labels[column * cell_] >> image.shift & image.mask) == label ? 1 : 0;
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

PartPlace::Cells PartPlace::cells_of(const Box& place) const {
  const auto cells = [this](double px) { return static_cast<int>(std::lround(px / cell_)); };
  const int left = cells(place.x - left_), top = cells(place.y - top_);
  const int right = cells(place.x + place.width - left_), bottom = cells(place.y + place.height - top_);
  return {left, top, right - left, bottom - top, std::max(1, cells(strip_of(place)))};
}

// What is outside of the image has none of the colours inside a place, and does not count around it.
PartPlace::Fill PartPlace::fill(const Cells& place) const {
  const auto in_columns = [this](int x) { return std::clamp(x, 0, columns_); };
  const auto in_rows = [this](int y) { return std::clamp(y, 0, rows_); };
  const int right = place.left + place.width, bottom = place.top + place.height, strip = place.strip;
  const int l = in_columns(place.left), r = in_columns(right), t = in_rows(place.top), b = in_rows(bottom);
  const int around_l = in_columns(place.left - strip), around_r = in_columns(right + strip);
  const int around_t = in_rows(place.top - strip), around_b = in_rows(bottom + strip);
  const int met = sum(l, t, r, b), met_around = sum(around_l, around_t, around_r, around_b) - met;
  const int cells = std::max(1, place.width * place.height);
  const int cells_around = std::max(1, (around_r - around_l) * (around_b - around_t) - (r - l) * (b - t));
  const double inside = double(met) / cells;
  return {inside, inside - double(met_around) / cells_around};
}

void PartPlace::begin(const LabelImage& image, std::uint16_t label, const Box& place) {
  place_.reset();
  if (!parameters_.enabled || image.empty() || place.empty()) return;
  cell_ = cell_for(place, 0.0);
  count(image, label, grown(place, strip_of(place), strip_of(place)));
  const Fill now = fill(cells_of(place));
  place_ = place;
  first_width_ = place.width;
  usual_ = now;
  contrast_ = now.contrast;
  lost_ = 0;
}

// In a corner of something much larger it would stay as small as it is: growing shows no more contrast there.
void PartPlace::resize(double ratio) {
  if (!place_) return;
  const double to = std::clamp(ratio * place_->width, kSmallest * first_width_, kLargest * first_width_);
  place_ = moved(*place_, 0.0, 0.0, to / place_->width);
}

// In steps of whole cells about where it was, of its size and a little smaller and larger.
PartPlace::Found PartPlace::search(double reach) const {
  constexpr double kFar = 0.1;       // what a step of its own size costs, in contrast
  constexpr double kResized = 0.03;  // what another size costs: it changes slowly
  const int steps = static_cast<int>(reach / cell_);
  const double far = kFar * cell_ * cell_ / place_->area();
  Found found;
  double best = -2.0;
  for (const double scale : {1.0, 0.95, 1.05}) {
    const double width = scale * place_->width;
    if (width < kSmallest * first_width_ || width > kLargest * first_width_) continue;
    const Cells cells = cells_of(moved(*place_, 0.0, 0.0, scale));
    for (int row = -steps; row <= steps; ++row) {
      for (int column = -steps; column <= steps; ++column) {
        Cells there = cells;
        there.left += column;
        there.top += row;
        const double merit =
            fill(there).contrast - far * (row * row + column * column) - (scale != 1.0 ? kResized : 0.0);
        if (merit <= best) continue;
        best = merit;
        found = {{column, row}, scale};
      }
    }
  }
  return found;
}

std::optional<Box> PartPlace::follow(const LabelImage& image, std::uint16_t label) {
  constexpr double kUsual = 0.05;   // share of an image in what is usual
  constexpr double kFollows = 0.2;  // share of a change of size that is followed in an image
  constexpr double kGrows = 0.3;    // of the reach, with each image without it
  constexpr double kTried = 1.05;   // in its size, at most
  if (!place_ || image.empty()) return std::nullopt;
  const double side = std::sqrt(place_->area());
  const double reach = std::min(kLargestStep, parameters_.reach * (1.0 + kGrows * lost_)) * side;
  const double margin = reach + kTried * strip_of(*place_) + (kTried - 1.0) * side;
  cell_ = cell_for(*place_, reach);
  count(image, label, grown(*place_, margin, margin));
  const auto [step, scale] = search(reach);
  const Box found = moved(*place_, step.x * cell_, step.y * cell_, 1.0);
  const Fill now = fill(cells_of(found));
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
  place_ = moved(found, 0.0, 0.0, 1.0 + kFollows * (scale - 1.0));
  return place_;
}

}  // namespace cgsr::person
