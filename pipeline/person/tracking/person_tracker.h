#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pipeline/person/colors/color_labels.h"
#include "pipeline/person/context.h"
#include "pipeline/person/face/face_tracks.h"
#include "pipeline/person/feedback.h"
#include "pipeline/person/tracking/face_color_classifier.h"
#include "pipeline/person/tracking/shirt_classifier.h"

namespace cgsr::person {

/// The class of everybody who is not enrolled.
inline constexpr Label kStranger = 0;

/// The primary characteristic: names the person whose face was recognised in this image, or a stranger (6.2.1).
class FaceClassifier final : public Classifier<PersonImage> {
 public:
  /// \param min_sure_confidence  from which on a face that is neither the person's of interest nor nearest to that person's counts under its own name.
  explicit FaceClassifier(double min_sure_confidence) : min_sure_confidence_(min_sure_confidence) {}

  std::optional<Classification> classify(const PersonImage& input) override;
  /// A shirt does not train a face, as in 6.2.4: who wears somebody else's would become that person. FaceTrainer does, by the face's own past.
  void train(Label, std::optional<Label>) override {}

 private:
  double min_sure_confidence_;
};

/// The other primary characteristic: names the person whose marker was read in this image, or a stranger (6.4.1.1).
class MarkerClassifier final : public Classifier<PersonImage> {
 public:
  std::optional<Classification> classify(const PersonImage& input) override;
  /// There is nothing to be trained: a marker's code is given.
  void train(Label, std::optional<Label>) override {}
};

struct PersonTrackerParameters {
  ShirtParameters shirt{};
  FaceColorParameters face_color{};
  ContextParameters context{};
  int faces_every = 2;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("shirt", self.shirt, "Shirts by their colours");
    visit.section("face_color", self.face_color, "Skin and hair by their colours (6.3)");
    visit.section("context", self.context, "How a disturbed image lowers confidence");
    visit.number("faces_every", self.faces_every, Range{1, 30}, "",
                 "A face is looked for in one of this many images once a shirt is known.");
  }
};

/// By which characteristic somebody was identified.
enum class PersonSource : std::uint8_t { kNone, kFace, kShirt, kFaceColor, kMarker };
std::string_view to_string(PersonSource source);

/// Who is in the image.
struct PersonSighting {
  std::optional<Label> person;  ///< nothing: nobody is identified; kStranger: somebody who is not enrolled.
  PersonSource source = PersonSource::kNone;
  double confidence = 0.0;
  Box box;             ///< of what identified him, in pixels of the image in which it was seen.
  int age_images = 0;  ///< since it was seen: 0 in this one; else between two looks for a face.
  double face_px =
      0.0;  ///< width of the face at the person's distance, seen, by its colours, by shirt or marker; 0: not known.
};

/// \return where the face above a shirt is looked for, both in pixels of one image. \param face_px  the face's width at the person's distance. Ours.
Box face_above(const Box& shirt, double face_px);

/// Whether a face is where one above that shirt may be, both in pixels of one image. Ours.
bool is_above(const Box& face, const Box& shirt);

/// One person from image to image by marker, face, face colour and shirt (6.2, 6.3): Alg. 6.1 with marker and face as primary and the two others as secondary
/// characteristics, and the scheduling of 6.2.3. A face or marker without its shirt relearns the shirt (6.2.4); between two looks for a face whoever the last one named is there, where nothing else says who is; a face overrides a shirt, until faces are looked for again, a stranger's for a second longer while no face is seen above it; a stranger's teaches it
/// nothing; the colours of a head that is followed show that what looks like the shirt elsewhere is none (6.3.1).
///
/// Threads: one.
class PersonTracker {
 public:
  /// \param min_sure_confidence  as FaceClassifier's.
  explicit PersonTracker(const PersonTrackerParameters& parameters = {},
                         double min_sure_confidence = FaceTrackParameters{}.min_sure_confidence);

  /// Whether a face is to be looked for in the next image: always until a shirt is known, if there is to be one, then in every other one (6.2.3).
  [[nodiscard]] bool face_is_due() const;

  /// \param input  of this image; its face is looked at only where face_is_due() said so.  \param contexts  how it was taken.
  PersonSighting update(const PersonImage& input, const PersonContexts& contexts = {});

  void forget(Label person);
  [[nodiscard]] const ShirtClassifier& shirts() const { return shirts_; }
  [[nodiscard]] const FaceColorClassifier& face_colors() const { return face_colors_; }

 private:
  // How large somebody was when he was measured last; everybody's own, for a child's shirt is not a man's.
  struct Size {
    Label person = 0;
    double face_px = 0.0;  // width of the last face that identified the person, or of what would be it by the marker
    // Of the shirt, by the width of the face above it; 0: never seen together and whole.
    double shirt_height_per_face = 0.0, shirt_width_per_face = 0.0;
  };
  void look_up(const ImageView& image, bool due);
  void locate(const PersonImage& input, Label person, PersonSighting& sighting) const;
  Size& size_of(Label person);
  [[nodiscard]] double face_px_of_shirt(const ImageView& image, const Box& shirt, Label person) const;
  void measure(const PersonImage& input, PersonSighting& sighting);
  [[nodiscard]] std::optional<PersonHead> head_of(const PersonImage& input) const;
  void confirm_head(const PersonImage& input, const PersonSighting& sighting);
  void keep_face(const PersonImage& input, bool due);
  [[nodiscard]] PersonSighting by_last_look() const;
  [[nodiscard]] bool is_below_other_face(const PersonSighting& sighting) const;

  PersonTrackerParameters parameters_;
  ColorLabels labels_;
  MarkerClassifier markers_;
  FaceClassifier faces_;
  FaceColorClassifier face_colors_;
  ShirtClassifier shirts_;
  FeedbackClassifier<PersonImage> feedback_;
  bool heads_first_ = false;               // the map of heads is made before that of shirts
  int since_face_ = 0;                     // images since one was looked for
  std::optional<PersonSighting> by_face_;  // who was decided on by face lately, see keep_face()
  int since_by_face_ = 0;                  // images
  Box shirt_before_;                       // in the last image
  std::vector<Size> sizes_;                // of those whose shirts are known, and of whoever was measured last
};

}  // namespace cgsr::person
