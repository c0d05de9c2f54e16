#include "pipeline/person/colors/blobs.h"

#include <algorithm>

namespace cgsr::person {

std::pair<int, int> LabelImage::corner_of(const Box& box) const {
  return {static_cast<int>(std::clamp(box.x, 0.0, double(width_px))),
          static_cast<int>(std::clamp(box.y, 0.0, double(height_px)))};
}

LabelImage LabelImage::within(const Box& box) const {
  const auto [left, top] = corner_of(box);
  LabelImage part = *this;
  part.labels = row(top) + left;
  part.width_px = static_cast<int>(std::clamp(box.x + box.width, 0.0, double(width_px))) - left;
  part.height_px = static_cast<int>(std::clamp(box.y + box.height, 0.0, double(height_px))) - top;
  return part;
}

int BlobFinder::root_of(int run) {
  while (runs_[static_cast<std::size_t>(run)].parent != run) {
    int& parent = runs_[static_cast<std::size_t>(run)].parent;
    parent = runs_[static_cast<std::size_t>(parent)].parent;  // halves the path
    run = parent;
  }
  return run;
}

void BlobFinder::join(int a, int b) {
  const int first = root_of(std::min(a, b)), second = root_of(std::max(a, b));
  if (first == second) return;
  const int keep = std::min(first, second), give = std::max(first, second);
  Blob& into = runs_[static_cast<std::size_t>(keep)].blob;
  const Blob& from = runs_[static_cast<std::size_t>(give)].blob;
  const double right = std::max(into.box.x + into.box.width, from.box.x + from.box.width);
  const double bottom = std::max(into.box.y + into.box.height, from.box.y + from.box.height);
  into.box.x = std::min(into.box.x, from.box.x);
  into.box.y = std::min(into.box.y, from.box.y);
  into.box.width = right - into.box.x;
  into.box.height = bottom - into.box.y;
  into.area_px += from.area_px;
  runs_[static_cast<std::size_t>(give)].parent = keep;
}

void BlobFinder::add_row(const LabelImage& image, int y, std::uint16_t max_label) {
  const std::uint16_t* row = image.row(y);
  const int shift = image.shift, mask = image.mask;
  for (int x = 0; x < image.width_px;) {
    const int label = row[x] >> shift & mask;
    const int begin = x;
    while (x < image.width_px && (row[x] >> shift & mask) == label) ++x;
    if (label == 0 || label > max_label) continue;
    const auto kind = static_cast<std::uint16_t>(label);
    const Blob blob{kind, x - begin, {double(begin), double(y), double(x - begin), 1.0}};
    runs_.push_back({begin, x, y, kind, static_cast<int>(runs_.size()), blob});
  }
}

// Both rows are in the order of their columns: a run touches those above whose columns overlap its own, widened by one for the diagonals.
void BlobFinder::connect(std::size_t above, std::size_t current) {
  std::size_t first = above;
  for (std::size_t i = current; i < runs_.size(); ++i) {
    while (first < current && runs_[first].end < runs_[i].begin) ++first;
    for (std::size_t j = first; j < current && runs_[j].begin <= runs_[i].end; ++j) {
      if (runs_[j].label == runs_[i].label) join(static_cast<int>(j), static_cast<int>(i));
    }
  }
}

std::span<const Blob> BlobFinder::largest(std::span<const std::uint16_t> labels, int width_px, int height_px,
                                          std::uint16_t max_label) {
  return largest({labels.data(), width_px, height_px, width_px}, max_label);
}

std::span<const Blob> BlobFinder::largest(const LabelImage& image, std::uint16_t max_label) {
  runs_.clear();
  largest_.clear();
  if (image.empty()) return largest_;
  std::size_t above = 0;
  for (int y = 0; y < image.height_px; ++y) {
    const std::size_t current = runs_.size();
    add_row(image, y, max_label);
    connect(above, current);
    above = current;
  }
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (runs_[i].parent != static_cast<int>(i)) continue;
    const Blob& blob = runs_[i].blob;
    const auto same = [&](const Blob& one) { return one.label == blob.label; };
    const auto known = std::find_if(largest_.begin(), largest_.end(), same);
    if (known == largest_.end()) {
      largest_.push_back(blob);
    } else if (blob.area_px > known->area_px) {
      *known = blob;
    }
  }
  std::sort(largest_.begin(), largest_.end(), [](const Blob& a, const Blob& b) { return a.label < b.label; });
  return largest_;
}

std::vector<Blob> BlobFinder::all(int min_area_px) const {
  std::vector<Blob> blobs;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (runs_[i].parent == static_cast<int>(i) && runs_[i].blob.area_px >= min_area_px) blobs.push_back(runs_[i].blob);
  }
  return blobs;
}

}  // namespace cgsr::person
