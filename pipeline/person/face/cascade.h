#pragma once

#include <string>
#include <vector>

#include <opencv2/objdetect.hpp>

#include "pipeline/person/face/grey_region.h"
#include "platform/error.h"

namespace cgsr::person {

/// What a cascade looks for in a patch.
struct CascadeSearch {
  double step = 1.1;      ///< factor from one size to the next.
  int min_neighbors = 1;  ///< how many overlapping detections count as one.
  int min_px = 20, max_px = 40;
};

/// A boosted cascade of Haar-like features (Viola and Jones, 2004), OpenCV's.
///
/// Threads: one. It allocates in every call.
class Cascade {
 public:
  /// \param xml  the text of a cascade's file.  \param example  a file that is one, for the error.
  /// \return an error that says what is wrong with the text.
  static Result<Cascade> from_xml(const std::string& xml, const char* example);

  /// \return what it finds, in pixels of the patch.
  std::vector<cv::Rect> find(const GreyPatch& patch, const CascadeSearch& search);

 private:
  Cascade() = default;

  cv::CascadeClassifier classifier_;
};

}  // namespace cgsr::person
