#pragma once

#include <optional>
#include <vector>

#include "pipeline/person/classifier.h"
#include "pipeline/person/marker/marker_detector.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::person {

/// Which marker is whose, and how it is looked for. Ours; 6.4.1.1 says only that a marker was on the shirt.
struct MarkerParameters {
  bool enabled = false;
  int id = 0;
  int number = 1;
  double side_per_face = 0.8;
  double min_side_px = 20.0;
  double region = 2.5;
  int min_reads = 2;
  int max_missed = 5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("enabled", self.enabled,
               "Whether markers are looked for; without person.identities they alone say who somebody is.");
    visit.number("id", self.id, Range{0, 49}, "", "The marker of the person: its number in OpenCV's DICT_4X4_50.");
    visit.number("number", self.number, Range{1, 1'000'000}, "",
                 "The number of the person who wears it, as in the identities file. Whoever wears another marker is a "
                 "stranger.");
    visit.number("side_per_face", self.side_per_face, Range{0.1, 5.0}, "",
                 "The side of the marker's black square, relative to the width of a face (task.person.face_width_m): "
                 "the distance follows from it.");
    visit.number("min_side_px", self.min_side_px, Range{16.0, 200.0}, "px",
                 "The side of the smallest marker that is looked for, in pixels of the camera.");
    visit.number("region", self.region, Range{1.5, 6.0}, "",
                 "The side of the region around an expected marker in which it is sought, relative to the marker.");
    visit.number("min_reads", self.min_reads, Range{1, 10}, "",
                 "A marker counts when it was read so many times: noise has a valid code now and then, but not at the "
                 "same place.");
    visit.number("max_missed", self.max_missed, Range{1, 30}, "",
                 "A marker that was not read in so many images is looked for in the whole image alone.");
  }
};

/// A marker that says whose the shirt is on which it is.
struct MarkerSighting {
  Box box;                      ///< its black square, in pixels of the image.
  Box face;                     ///< where the face of who wears it on the chest would be, and how large, by its size.
  std::optional<Label> person;  ///< nothing: a stranger, who wears another marker.
  double confidence = 0.0;      ///< SeenMarker's.
};

/// The marker of the person, and one of somebody else, from image to image: each is looked for around the place that its last motion leads to, and in slices
/// of the whole image where the person's is not seen.
///
/// Threads: one. Finding markers allocates.
class MarkerTracks {
 public:
  explicit MarkerTracks(const MarkerParameters& parameters = {});

  /// One unit of the budget for each marker that is expected somewhere, one for a slice of the whole image.
  void look(const ImageView& image, WorkBudget& budget);

  /// \return the person's marker where it was read in this image, else somebody else's; nothing: neither was.
  [[nodiscard]] std::optional<MarkerSighting> sighting() const;
  /// \return the same as the detector saw it.
  [[nodiscard]] std::optional<SeenMarker> seen() const;

 private:
  struct Track {
    SeenMarker last;
    double right_px = 0.0, down_px = 0.0;  // its motion from image to image
    bool seen = false;                     // in this image
    int reads = 0;                         // 0: it is expected nowhere
    int missed = 0;                        // images since it was read
  };
  void follow(Track& track, const ImageView& image, WorkBudget& budget);
  void note(Track& track, const SeenMarker& marker) const;
  [[nodiscard]] const Track* shown() const;

  MarkerParameters parameters_;
  MarkerDetector detector_;
  Track person_;
  Track other_;
  std::vector<SeenMarker> found_;
};

}  // namespace cgsr::person
