#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/box.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::person {

struct FaceDetectorParameters {
  double min_face_px = 40.0;
  double region = 1.6;
  int min_neighbors = 2;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("min_face_px", self.min_face_px, Range{20.0, 400.0}, "px",
                 "The smallest face that the search through the whole image looks for, in pixels of the camera; 80 is "
                 "what an image of 160x120 shows.");
    visit.number("region", self.region, Range{1.2, 6.0}, "",
                 "The side of the region around an expected face in which it is sought, relative to the face.");
    visit.number("min_neighbors", self.min_neighbors, Range{0, 10}, "", "How many overlapping detections make a face.");
  }
};

/// Finds frontal faces (6.2.1): a boosted cascade of Haar-like features (Viola and Jones, 2004), OpenCV's. An expected face is sought near its place
/// with a region scaled to the same few pixels however near the face is; the search through the whole image is cut into slices of about equal work.
///
/// Threads: one. The cascade allocates in every call.
class FaceDetector {
 public:
  /// \param cascade_xml  the text of a cascade's file; whoever reads files has read it.
  /// \return an error that says what is wrong with the text.
  static Result<FaceDetector> from_cascade(const std::string& cascade_xml, const FaceDetectorParameters& parameters);
  FaceDetector(FaceDetector&&) noexcept;
  FaceDetector& operator=(FaceDetector&&) noexcept;
  ~FaceDetector();

  /// \param expected  where a face of about this size should be.
  /// \return the face nearest to it, or nothing.
  /// Cost: 5 million instructions.
  std::optional<Box> find_near(const ImageView& image, const Box& expected);

  /// Goes on with the search through the whole image, a slice per grant, over this image and those that follow.
  /// Cost: 4 million instructions per grant, and 5 for each face that is found.
  /// \param found  faces of these slices are appended, each once, in the place and size that find_near() gives it.
  void search(const ImageView& image, WorkBudget& budget, std::vector<Box>& found);

  /// All slices on one image.
  std::vector<Box> find_all(const ImageView& image);

  /// \return of how many slices a search through a whole image of this size consists.
  [[nodiscard]] std::size_t slices(int width_px, int height_px) const;

 private:
  struct Cascade;
  FaceDetector(std::unique_ptr<Cascade> cascade, const FaceDetectorParameters& parameters);
  void find_in_slice(const ImageView& image, const Box& region, double face_px, std::vector<Box>& found);

  std::unique_ptr<Cascade> cascade_;
  FaceDetectorParameters parameters_;
  std::size_t next_slice_ = 0;
};

}  // namespace cgsr::person
