#pragma once

#include <optional>

#include "pipeline/imaging/reduce.h"
#include "pipeline/person/classifier.h"
#include "pipeline/person/colors/blobs.h"
#include "pipeline/person/colors/person_colors.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/marker/marker_tracks.h"
#include "platform/box.h"
#include "platform/image_view.h"
#include "platform/parameters.h"

namespace cgsr::person {

/// A face that was found and compared.
struct FaceSighting {
  Box box;  ///< in pixels of the image.
  FaceMatch match;
};

/// What the classifiers of a person look at.
struct PersonImage {
  ImageView image;  ///< YUYV, of at most the size that the tracker was made for.
  std::optional<FaceSighting> face = std::nullopt;
  std::optional<Label> interest =
      std::nullopt;  ///< whose shirt counts where several are in view; nothing: the largest.
  std::optional<MarkerSighting> marker = std::nullopt;  ///< that was read in this image.
};

/// Where colours are sampled around a marker on a shirt: below its white margin, nearly as large as a face; the background beside the face as for a face
/// (Fig. 6.3), where neither shirt nor arms are.
SamplingRegions sampling_regions(const MarkerSighting& marker);

struct ShirtParameters {
  PersonColorParameters colors{};
  int images_to_learn = 10;
  double min_area = 0.15;
  double max_width = 6.0;
  double confidence = 0.7;
  int max_width_px = 640;
  int max_height_px = 480;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("colors", self.colors, "Colours of people");
    visit.number("images_to_learn", self.images_to_learn, Range{1, 100}, "",
                 "A shirt is learned when its person's face was recognised in so many images.");
    visit.number("min_area", self.min_area, Range{0.0, 10.0}, "",
                 "The smallest area of a shirt, relative to that of its person's face when it was last seen.");
    visit.number("max_width", self.max_width, Range{1.0, 50.0}, "",
                 "The largest width of a shirt, relative to that of its person's face when it was last seen.");
    visit.number("confidence", self.confidence, Range{0.0, 1.0}, "",
                 "How likely a shirt of plausible size is its person's: ambiguous, so less than a face.");
    visit.number("max_width_px", self.max_width_px, Range{16, 4096}, "px", "The width of the largest image.");
    visit.number("max_height_px", self.max_height_px, Range{16, 4096}, "px", "The height of the largest image.");
  }
};

/// The secondary characteristic: the person whose shirt's colours make the largest blob of plausible size (6.2.2); where the shirt of the person of
/// interest is in view, that person, however large the others are.
///
/// Threads: one. Allocates when it is trained.
class ShirtClassifier final : public Classifier<PersonImage> {
 public:
  explicit ShirtClassifier(const ShirtParameters& parameters = {});

  std::optional<Classification> classify(const PersonImage& input) override;
  /// Relearns the shirt below the face or under the marker of the same input (6.2.4); without either, or for a stranger, nothing is learned.
  void train(Label label, std::optional<Label> mistaken_for) override;

  /// Counts the images in which the same person's marker or face is recognised, and learns the shirt under it after so many in a row. A marker that is
  /// the person's comes before a face.
  void observe(const PersonImage& input);
  void forget(Label person);

  /// \return the shirt that was found last.
  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] std::size_t people() const { return colors_.people(); }
  [[nodiscard]] bool knows(Label person) const { return colors_.knows(person); }

 private:
  /// Who says whose a shirt is, and where it is then.
  struct Teacher {
    std::optional<Label> person;  // nothing: a stranger
    Box face;                     // seen, or where it would be
    SamplingRegions regions;
  };
  static std::optional<Teacher> teacher_of(const PersonImage& input);
  void learn(const PersonImage& input, const Teacher& teacher);
  [[nodiscard]] bool is_plausible(const Box& shirt, double area_px2) const;

  ShirtParameters parameters_;
  PersonColors colors_;
  imaging::LabelTable map_;
  bool map_is_due_ = true;  // something was learned since it was made
  imaging::ReducedImage reduced_;
  BlobFinder blobs_;
  PersonImage last_;              // what train() learns from; its pixels are valid until the next classify()
  std::optional<Box> last_face_;  // of a recognised person, or where it would be by the marker
  std::optional<Label> seen_;     // in the images before this one
  int seen_images_ = 0;
  Box box_;
};

}  // namespace cgsr::person
