#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/person/colors/blobs.h"
#include "platform/box.h"
#include "platform/parameters.h"

namespace cgsr::person {

struct PartPlaceParameters {
  bool enabled = true;
  double reach = 0.35;
  double min_of_usual = 0.6;
  double min_contrast = 0.15;
  int max_lost = 45;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("enabled", self.enabled,
               "Whether a shirt is followed from image to image at its place and of its size, where no blob of its "
               "colours is there alone.");
    visit.number("reach", self.reach, Range{0.05, 1.3}, "",
                 "How far it may move from one image to the next, in its sides; farther after images without it.");
    visit.number(
        "min_of_usual", self.min_of_usual, Range{0.0, 1.0}, "",
        "The share of its place that must have its colours, and the contrast to what is around it, relative to "
        "what they have been lately: below, it is covered, and its place is kept until it is seen again.");
    visit.number("min_contrast", self.min_contrast, Range{0.0, 1.0}, "",
                 "By how much a larger share of its place must have its colours than of what is around it.");
    visit.number("max_lost", self.max_lost, Range{1, 1000}, "",
                 "It is given up after so many images in a row in which it was not found.");
  }
};

/// A part of known size from image to image by its colours, where its blob is no guide: behind, beside or before what has some of them too. Where a box as
/// large as it holds more of the colours than the strip around it does is where it is: near where it was (the vetoes by size, position and motion of 6.3.1).
/// Ours.
///
/// Threads: one. Allocates only where a window is larger than any before it.
class PartPlace {
 public:
  explicit PartPlace(const PartPlaceParameters& parameters = {}) : parameters_(parameters) {}

  /// The part is here. \param place  in pixels of the image.
  void begin(const LabelImage& image, std::uint16_t label, const Box& place);
  void end() { place_.reset(); }

  /// What the part is in looks so many times as large as an image before: so does the part.
  void resize(double ratio);

  /// Looks for the part in the next image. \return where it is; nothing: not found, given up, or never begun.
  /// Cost: .3 million instructions, at most .8.
  std::optional<Box> follow(const LabelImage& image, std::uint16_t label);

  /// \return where it was found last; nothing: given up, or never begun.
  [[nodiscard]] const std::optional<Box>& place() const { return place_; }
  /// By how much more of its place than of what is around it had the colours, in [-1, 1], when it was found last.
  [[nodiscard]] double contrast() const { return contrast_; }

 private:
  struct Fill {
    double inside = 0.0, contrast = 0.0;
  };
  // A place in a window, and the width of the strip around it.
  struct Cells {
    int left = 0, top = 0, width = 0, height = 0, strip = 0;
  };
  struct Step {
    int x = 0, y = 0;  // cells
  };
  struct Found {
    Step step{};
    double scale = 1.0;
  };
  // Of a window, in cells: how many of those above and to the left have the label.
  void count(const LabelImage& image, std::uint16_t label, const Box& window);
  [[nodiscard]] int sum(int left, int top, int right, int bottom) const;
  [[nodiscard]] Cells cells_of(const Box& place) const;
  [[nodiscard]] Fill fill(const Cells& place) const;
  [[nodiscard]] Found search(double reach) const;

  PartPlaceParameters parameters_;
  std::optional<Box> place_;
  double first_width_ = 0.0;  // at begin()
  double contrast_ = 0.0;
  Fill usual_{};  // slowly followed
  int lost_ = 0;
  std::vector<int> counts_;
  int left_ = 0, top_ = 0, columns_ = 0, rows_ = 0, cell_ = 1;  // of the window; a cell is one pixel of cell_ x cell_
};

}  // namespace cgsr::person
