#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>

#include "pipeline/person/face/face_tracks.h"
#include "pipeline/person/marker/marker_tracks.h"
#include "pipeline/person/tracking/person_tracker.h"
#include "platform/image_view.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::person {

struct IdentifierParameters {
  FaceDetectorParameters detector{};
  FaceTrackParameters faces{};
  FaceMatchParameters match{};
  PersonTrackerParameters tracker{};
  MarkerParameters marker{};
  int answer_after_images = 3;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("detector", self.detector, "Finding faces (6.2.1)");
    visit.section("faces", self.faces, "Following faces from image to image and naming them");
    visit.section("match", self.match, "Telling whose a face is");
    visit.section("tracker", self.tracker, "Face and shirt of the person (6.2)");
    visit.section("marker", self.marker, "A marker on the shirt of the person (6.4.1.1)");
    visit.number("answer_after_images", self.answer_after_images, Range{1, 30}, "",
                 "In lock-step a face is named so many images after it was seen; live as soon as it was compared.");
  }
};

/// A face in view.
struct SeenFace {
  std::uint32_t number = 0;     ///< of its track.
  Box box;                      ///< in pixels of the image.
  bool compared = false;        ///< whether it is known whose it is.
  std::optional<Label> person;  ///< nothing: not known yet, or, where compared, a stranger.
  double confidence = 0.0;      ///< of that; 0 where it was not compared.
};

/// Who is in view.
struct PeopleInView {
  PersonSighting person;  ///< the one of interest, by face, shirt or marker.
  std::optional<Box>
      expected_face{};  ///< where his face would be, in pixels of the image, of which it may lie outside; nothing: not known, or he is a stranger.
  std::array<SeenFace, FaceTracks::kMaxFaces> faces{};
  std::size_t face_count = 0;

  [[nodiscard]] std::span<const SeenFace> seen_faces() const { return {faces.data(), face_count}; }
};

/// Chapter 6 for an image after the other: faces are followed and named, one of them and the marker are the primary characteristics of Alg. 6.1, the shirt
/// below them the secondary one.
///
/// Threads: one. Finding faces and markers allocates.
class Identifier {
 public:
  /// \param detector  of faces; nothing: faces are not looked for, the marker alone says who somebody is.  \param recognizer  not null where there is a
  ///     detector.
  Identifier(std::optional<FaceDetector> detector, std::unique_ptr<FaceRecognizer> recognizer,
             const IdentifierParameters& parameters = {});

  /// \param image  YUYV.  \param asked  whose face and shirt count where several are in view; nothing: the latest person of interest, who is the last one
  ///     that was identified and is still there; if there is none, the largest face that is known.
  /// \param budget  markers first, then a unit for each known face that is looked for, for the place above the shirt, and for each step of the search for others.
  PeopleInView identify(const ImageView& image, std::optional<Label> asked, WorkBudget& budget);

 private:
  void look_for_faces(const ImageView& image, WorkBudget& budget);
  void exchange_with_recognizer(const ImageView& image);
  [[nodiscard]] std::optional<FaceSighting> face_of(std::optional<Label> asked) const;
  [[nodiscard]] bool is_beside(const FaceTrack& face, std::optional<Label> asked) const;
  [[nodiscard]] std::optional<MarkerSighting> marker_of() const;
  [[nodiscard]] PersonContexts contexts_of(const ImageView& image, const std::optional<FaceSighting>& face,
                                           const std::optional<MarkerSighting>& marker) const;
  void remember(const PersonSighting& now, std::optional<Label> asked);
  [[nodiscard]] std::optional<Box> expected_face() const;

  std::optional<FaceTracks> faces_;
  std::unique_ptr<FaceRecognizer> recognizer_;
  std::optional<MarkerTracks> markers_;
  PersonTracker tracker_;
  PersonSighting last_;
  std::optional<Box> last_marker_face_;  // where the face above the marker would be
  std::optional<Label> interest_;        // the latest person of interest
  int images_without_ = 0;               // since the latest person of interest was identified
  bool asking_ = false;
};

}  // namespace cgsr::person
