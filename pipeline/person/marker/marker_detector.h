#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::person {

/// Where a marker was looked for when it was found.
enum class MarkerSearch : std::uint8_t {
  kWholeImage,  ///< in a slice of the search through the whole image.
  kPrediction,  ///< around the place where it was expected.
};
std::string_view to_string(MarkerSearch search);

/// A marker that was read.
struct SeenMarker {
  int id = 0;
  Box box;                  ///< around the corners of its black square, in pixels of the image.
  double confidence = 0.0;  ///< the share of its pixels that are as its code says: 1 for a clean one, 0.5 for chance.
  MarkerSearch search = MarkerSearch::kWholeImage;
};

/// Reads ArUco markers (OpenCV's, DICT_4X4_50), here in place of ARTags (6.4.1.1): around an expected place at about the same few pixels however near
/// the marker is, or in the whole image, a slice in each call. Only codes without a wrong bit count, and of their pixels most have to agree.
///
/// Threads: one. OpenCV allocates in every call.
class MarkerDetector {
 public:
  /// \param min_side_px  of the smallest marker that is looked for, in pixels of the image, at least 12: three for each of its cells are needed for reading.
  /// \param region  the side of the region around an expected marker in which it is sought, relative to the marker.
  MarkerDetector(double min_side_px, double region);
  MarkerDetector(MarkerDetector&&) noexcept;
  MarkerDetector& operator=(MarkerDetector&&) noexcept;
  ~MarkerDetector();

  /// \param image  YUYV, grey or B G R.  \param expected  where a marker of about this size should be.
  /// \return the marker of this id that is nearest to it; nothing: it is not there, covered, cut off, blurred, or the image is empty.
  std::optional<SeenMarker> find_near(const ImageView& image, const Box& expected, int id);

  /// One slice of the search through the whole image, which goes on over this image and those that follow: the whole of it is seen at its own size, at half
  /// of it and so on, each size in tiles that overlap by as much as its largest marker.
  /// \param found  out: the markers in the slice, none twice.
  void search(const ImageView& image, std::vector<SeenMarker>& found);

  /// \return of how many slices a round through an image of this size consists.
  [[nodiscard]] std::size_t steps(int width_px, int height_px) const;

 private:
  struct Reader;
  std::vector<SeenMarker> read(const ImageView& image, const Box& region, double shrink, MarkerSearch search);

  std::unique_ptr<Reader> reader_;
  double min_side_px_;
  double region_;
  std::size_t next_slice_ = 0;
};

}  // namespace cgsr::person
