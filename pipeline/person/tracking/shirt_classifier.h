#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/person/classifier.h"
#include "pipeline/person/colors/blobs.h"
#include "pipeline/person/colors/color_labels.h"
#include "pipeline/person/colors/part_light.h"
#include "pipeline/person/colors/part_place.h"
#include "pipeline/person/colors/person_colors.h"
#include "pipeline/person/marker/marker_tracks.h"
#include "pipeline/person/tracking/person_image.h"
#include "pipeline/person/tracking/shirt_regions.h"
#include "platform/box.h"
#include "platform/parameters.h"

namespace cgsr::person {

struct ShirtParameters {
  bool enabled = true;
  PersonColorParameters colors{};
  PartLightParameters light{};
  PartPlaceParameters place{};
  int images_to_learn = 10;
  int images_between = 15;
  double min_area = 0.15;
  double max_width = 6.0;
  double confidence = 0.7;
  int max_width_px = 640;
  int max_height_px = 480;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("enabled", self.enabled, "Whether a person is followed by the shirt too, where the face is not seen.");
    visit.section("colors", self.colors, "Colours of people");
    visit.section("light", self.light, "How the light on a shirt is followed");
    visit.section("place", self.place, "How the place of a shirt is followed");
    visit.number("images_to_learn", self.images_to_learn, Range{1, 100}, "",
                 "A shirt is learned when its person's face was recognised in so many images.");
    visit.number("images_between", self.images_between, Range{1, 1000}, "",
                 "A shirt that was relearned, or told from its background, and is still not found is not learned again "
                 "for so many images.");
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
/// interest is in view, that person, however large the others are; colours that several people wear are those of the latest person of interest. Where somebody's head is known, his shirt is below it and nowhere else. It is
/// looked for in the light that is on it (PartLight); when it is lost at once, once more in the light in which its place would be the shirt; after a long loss under the light of learning, in turns. From the
/// last face or marker on it is followed at its place too (PartPlace): a blob that is elsewhere, or of another size, is not believed while it is there, and what
/// it looks like there is added to its colours now and then, a bounded number of samples at a time, without what is more frequent beside it. Just after a loss
/// a much smaller blob elsewhere is not believed.
///
/// Threads: one. Allocates when it is trained.
class ShirtClassifier final : public Classifier<PersonImage> {
 public:
  /// \param labels  of both colour parts; outlives this.
  ShirtClassifier(ColorLabels& labels, const ShirtParameters& parameters);

  /// Before the image is looked up: makes the map of shirts, when something was learned or the light has changed. \return whether it did.
  bool prepare();

  std::optional<Classification> classify(const PersonImage& input) override;
  /// Relearns the shirt below the face or under the marker of the same input (6.2.4); without either, for a stranger, or where the image ends above the shirt,
  /// nothing is learned.
  void train(Label label, std::optional<Label> mistaken_for) override;
  /// What the last classify() found with the colours of the shirt, and not below its person's head, is a negative sample from now on (6.3.1): the head is
  /// seen. Nothing happens where there was no such thing, or where it was done lately.
  void learn_negative();

  /// Counts the images in which the same person's marker or face is recognised, and learns the shirt under it after so many in a row. A marker that is
  /// the person's comes before a face.
  void observe(const PersonImage& input);
  void forget(Label person);

  /// \return the shirt that was found last; empty: none in the last image.
  [[nodiscard]] const Box& box() const { return box_; }
  /// \return the face's width at the distance of the shirt that was found last, by the size of its place; nothing: it was not found, or its blob is the
  ///     better guide.
  [[nodiscard]] std::optional<double> face_px() const;
  [[nodiscard]] std::size_t people() const { return colors_.people(); }
  [[nodiscard]] bool knows(Label person) const { return colors_.knows(person); }
  /// \return the light under which a person's shirt is looked for; nothing: it is not known.
  [[nodiscard]] std::optional<color::Light> light_of(Label person) const { return light_.of(person); }

 private:
  /// Who says whose a shirt is, and where it is then.
  struct Teacher {
    std::optional<Label> person;  // nothing: a stranger
    Box face;                     // seen, or where it would be
    SamplingRegions regions;
  };
  static std::optional<Teacher> teacher_of(const PersonImage& input);
  void learn(const PersonImage& input, const Teacher& teacher);
  [[nodiscard]] bool is_plausible(Label person, const Box& shirt, double area_px2) const;
  void remember_face(Label person, const Box& face);
  void prefer(Label person);
  std::optional<Label> find(const PersonImage& input);
  bool find_below(const PersonHead& head, int image_height_px);
  std::optional<Label> find_at_place(const PersonImage& input, std::optional<Label> by_blob);
  [[nodiscard]] bool is_scrap_elsewhere(const PersonImage& input, Label person) const;
  [[nodiscard]] bool is_passer_by(const Teacher& teacher) const;
  void follow_from(const Teacher& teacher);
  void follow_size(const ImageView& image, std::optional<Label> by_blob);
  void learn_at_place(const PersonImage& input, const Box& trunk);
  [[nodiscard]] std::uint16_t label_of(Label person) const;
  void found(const PersonImage& input, Label person);
  void lost(const PersonImage& input);
  void take_back_supposed();
  [[nodiscard]] int pixels_in(const Box& window) const;
  void check_light();

  ShirtParameters parameters_;
  ColorLabels& labels_;
  PersonColors colors_;
  PartLight light_;
  imaging::LabelTable map_;
  std::vector<Label> order_;        // the people by their labels in the map; some may be forgotten since
  std::optional<Label> preferred_;  // the latest person of interest: colours that others have too are his
  bool map_is_due_ = true;          // something was learned since it was made, or the light has changed
  BlobFinder blobs_;
  PersonImage last_;  // what train() learns from; its pixels are valid until the next classify()
  // Of everybody whose shirt is known, and of whoever was recognised last: the last face, or where it would be by the marker.
  std::vector<PersonHead> last_faces_;
  std::optional<Label> seen_;  // in the images before this one
  int seen_images_ = 0;
  Box box_;
  Box elsewhere_;  // has the colours of the person whose head is known, and is not below it; empty: nothing has
  std::optional<Label> person_;  // whose shirt was found last, and where
  Box place_;
  PartPlace followed_;                    // the trunk, in pixels of the labels' image
  std::optional<Label> followed_person_;  // whose
  Box holder_;                            // the blob that holds the trunk, when it changed last; empty: none does
  bool is_sized_by_place_ = false;        // how far away the shirt is says the trunk, not its blob
  int since_place_learned_ = 0;
  int missed_ = 0;         // images since then; 0: it was found in the last one
  bool supposed_ = false;  // the map is of a light that is only supposed
  // In the image in which the shirt's light was said to have changed: where it was, with room to move, and how many pixels of it were there.
  struct Before {
    Box window;
    int pixels = 0;
  };
  std::optional<Before> before_light_;
  int since_trained_ = 0;   // images since a shirt was relearned and not found since; 0: was found
  int since_shared_ = 0;    // images since a shirt was relearned that was taken for the preferred person's; 0: never
  int since_negative_ = 0;  // images since negative samples were learned; 0: never
};

}  // namespace cgsr::person
