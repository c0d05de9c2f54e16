#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/box.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/parameters.h"

namespace cgsr::person {

class Cascade;

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

/// \return whether two boxes are of one face: their centres are nearer to each other than two faces side by side can be.
bool same_face(const Box& a, const Box& b);

/// A step of the search through a whole image.
struct SearchStep {
  Box region;                ///< in which it looks, in pixels of the image.
  double min_face_px = 0.0;  ///< the smallest face that it looks for.
  double max_face_px = 0.0;  ///< the largest, which lies wholly in one of the regions wherever it is.
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
  /// Cost: 4 million instructions where there is a face, 1 where there is none.
  std::optional<Box> find_near(const ImageView& image, const Box& expected);

  /// One step of the search through the whole image, which goes on over this image and those that follow: a slice, in which faces are noticed, or a
  /// close look at a place where one was noticed. Slices are searched at every other position, as 6.2.1 does with an image of 160x120; each
  /// round looks at positions that the one before it left out, and for sizes between its sizes, so that a face missed in one is met in another.
  /// Cost: 2 million instructions for a slice, at most 5; 4 for a close look.
  /// \param faces  in: those that are known, which are not looked at again; out: a new one is appended, in the place and size that find_near()
  ///     gives it.
  void search(const ImageView& image, std::vector<Box>& faces);

  /// All faces of one image, every position looked at, in steps of a tenth of the size: for enrolment and single images, not for the frame path.
  std::vector<Box> find_all(const ImageView& image);

  /// The same in equalized_locally(): dark faces in a bright room, and more of what is none.
  std::vector<Box> find_all_dark(const ImageView& image);

  /// \return the slices of which a round through a whole image of this size consists. \param round  eight follow each other, and begin again.
  [[nodiscard]] std::vector<SearchStep> round_of(int width_px, int height_px, std::size_t round = 0) const;

 private:
  FaceDetector(std::unique_ptr<Cascade> cascade, const FaceDetectorParameters& parameters);

  std::unique_ptr<Cascade> cascade_;
  FaceDetectorParameters parameters_;
  std::size_t round_ = 0;  // through the whole image
  std::size_t next_slice_ = 0;
  std::vector<Box> noticed_;  // where faces were noticed and not looked at closely yet
};

}  // namespace cgsr::person
