#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "platform/box.h"

namespace cgsr::person {

/// Pixels of one label that touch each other, diagonally too.
struct Blob {
  std::uint16_t label = 0;
  int area_px = 0;
  Box box;  ///< in pixels of the label image.
};

/// Labels of pixels: rows of width_px, stride apart. What counts of a pixel is (value >> shift) & mask.
struct LabelImage {
  const std::uint16_t* labels = nullptr;
  int width_px = 0;
  int height_px = 0;
  int stride = 0;
  int shift = 0;
  int mask = 0xFFFF;

  [[nodiscard]] bool empty() const { return width_px <= 0 || height_px <= 0; }
  [[nodiscard]] const std::uint16_t* row(int y) const { return labels + std::ptrdiff_t{y} * stride; }
  [[nodiscard]] std::uint16_t at(int x, int y) const { return static_cast<std::uint16_t>(row(y)[x] >> shift & mask); }
  /// \param box  in pixels of this image.  \return what lies within both; blobs that are found in it are in pixels of the part.
  [[nodiscard]] LabelImage within(const Box& box) const;
  /// \return the left upper corner of within(box).
  [[nodiscard]] std::pair<int, int> corner_of(const Box& box) const;
};

/// Finds the largest blob of every label in one pass over the rows (6.2.2; the runs of Sridharan and Stone, 2005). Label 0 is nobody's.
///
/// Threads: one. Allocates only where an image has more runs than any before it.
class BlobFinder {
 public:
  /// \param labels  rows of width_px, tight.  \param max_label  larger labels are left out.
  /// \return the largest blob of each label that occurs, by label; valid until the next call.
  /// Cost: about 4 instructions per pixel, and 30 per run.
  std::span<const Blob> largest(std::span<const std::uint16_t> labels, int width_px, int height_px,
                                std::uint16_t max_label);

  /// The same for any image of labels.
  std::span<const Blob> largest(const LabelImage& image, std::uint16_t max_label);

  /// All blobs of the last call that have at least this area, in the order of their first pixels.
  [[nodiscard]] std::vector<Blob> all(int min_area_px) const;

 private:
  struct Run {
    int begin, end;  // columns
    int row;
    std::uint16_t label;
    int parent;  // of the forest of runs; a root is its own
    Blob blob;   // of a root: what has been joined so far
  };
  int root_of(int run);
  void join(int a, int b);
  void add_row(const LabelImage& image, int y, std::uint16_t max_label);
  void connect(std::size_t above, std::size_t current);

  std::vector<Run> runs_;
  std::vector<Blob> largest_;
};

}  // namespace cgsr::person
