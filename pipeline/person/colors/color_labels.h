#pragma once

#include <cstdint>
#include <span>

#include "pipeline/imaging/reduce.h"
#include "pipeline/person/colors/blobs.h"

namespace cgsr::person {

/// What of a person is known by its colours: each is a secondary characteristic (6.2.2, 6.3.1).
enum class ColorPart : std::uint8_t { kShirt, kHead };
std::string_view to_string(ColorPart part);

/// Whose shirt and whose head each pixel is by its colour: both RGB-to-person maps in one table, so that one pass over the image serves both. Ours.
///
/// Threads: one. look() allocates nothing.
class ColorLabels {
 public:
  static constexpr int kFactor = 2;        ///< people's colours are sought at 320x240 (6.2.2).
  static constexpr int kMaxPeople = 0xFF;  ///< a map knows no more.

  /// \param max_width_px, max_height_px  of the camera's largest image.
  ColorLabels(int max_width_px, int max_height_px);

  /// \param map  of PersonColors::make_map: 0 is nobody, at most kMaxPeople.
  void set(ColorPart part, const imaging::LabelTable& map);

  /// Looks an image up. \return whether it could be: YUYV of a size that this was made for.
  bool look(const ImageView& image);

  /// The last image by one part, in pixels of kFactor x kFactor of the camera's. Empty before the first, and where it could not be looked up.
  [[nodiscard]] LabelImage of(ColorPart part) const;

 private:
  imaging::LabelTable table_;
  imaging::ReducedImage reduced_;
};

}  // namespace cgsr::person
