#pragma once

#include <optional>

#include "pipeline/person/classifier.h"
#include "pipeline/person/colors/blobs.h"
#include "pipeline/person/colors/color_labels.h"
#include "pipeline/person/colors/person_colors.h"
#include "pipeline/person/tracking/person_image.h"
#include "platform/box.h"
#include "platform/parameters.h"

namespace cgsr::person {

struct FaceColorParameters {
  bool enabled = true;
  PersonColorParameters colors{};
  int images_to_learn = 10;
  int images_between = 30;
  double min_area = 0.25;
  double max_area = 3.0;
  double reach = 0.5;
  int max_images = 90;
  double confidence = 0.6;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("enabled", self.enabled,
               "Whether a person is followed by the colours of skin and hair too, where face and shirt are not seen.");
    visit.section("colors", self.colors, "Colours of skin and hair");
    visit.number("images_to_learn", self.images_to_learn, Range{1, 100}, "",
                 "They are learned when their person's face was recognised in so many images.");
    visit.number("images_between", self.images_between, Range{1, 1000}, "",
                 "They are learned anew below a face at most once in so many images.");
    visit.number("min_area", self.min_area, Range{0.0, 1.0}, "",
                 "The smallest area of skin and hair, relative to that of the face's box.");
    visit.number("max_area", self.max_area, Range{1.0, 20.0}, "",
                 "The largest area of skin and hair, relative to that of the face's box.");
    visit.number("reach", self.reach, Range{0.05, 5.0}, "",
                 "How far a head may move from one image to the next, in widths of the face.");
    visit.number("max_images", self.max_images, Range{1, 10000}, "",
                 "A head that neither face nor shirt has confirmed for so many images is not believed any longer.");
    visit.number("confidence", self.confidence, Range{0.0, 1.0}, "",
                 "How likely what has the colours of a head, and is where the head was, is its person's.");
  }
};

/// Another secondary characteristic: the colours of skin and hair (6.3.1). They are everybody's, so they are looked for only where the head of the person was
/// an image before (the motion cue), and tell for a limited time who it is when neither face nor shirt does. Those that several people have are the
/// person's whose head was followed last.
///
/// Threads: one. Allocates when it is trained.
class FaceColorClassifier final : public Classifier<PersonImage> {
 public:
  /// \param labels  of both colour parts; outlives this.
  FaceColorClassifier(ColorLabels& labels, const FaceColorParameters& parameters);

  /// Before the image is looked up: makes the map of heads, when something was learned. \return whether it did.
  bool prepare();

  std::optional<Classification> classify(const PersonImage& input) override;
  /// Relearns the colours of the face of the same input (6.2.4); without a face nothing is learned.
  void train(Label label, std::optional<Label> mistaken_for) override;

  /// Counts the images in which a face is recognised, and learns its colours after so many in a row.
  void observe_face(const PersonImage& input, const FaceSighting& face);
  /// Where the head of a person is in this image, by his face or above his shirt.
  void confirm(Label person, const Box& head);
  void forget(Label person);

  /// \return where the person's head was in the last image; nothing: it has not been seen by face, shirt or colour in the last three.
  [[nodiscard]] std::optional<PersonHead> head() const;
  [[nodiscard]] bool knows(Label person) const { return colors_.knows(person); }

 private:
  void learn(const PersonImage& input, const FaceSighting& face);

  FaceColorParameters parameters_;
  ColorLabels& labels_;
  PersonColors colors_;
  imaging::LabelTable map_;
  bool map_is_due_ = true;
  BlobFinder blobs_;
  PersonImage last_;           // what train() learns from
  std::optional<Label> seen_;  // by face, in the images before this one
  int seen_images_ = 0;
  int since_trained_ = 0;  // images; 0: never
  std::optional<Label>
      preferred_;  // has the colours that others have too: who was learned, or whose head was followed, last
  std::optional<PersonHead> head_;
  int unseen_ = 0;       // images since the head was seen by anything
  int unconfirmed_ = 0;  // images since it was seen by face or shirt
};

}  // namespace cgsr::person
