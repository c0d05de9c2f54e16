#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/person/face/face_detector.h"
#include "pipeline/person/face/face_recognizer.h"
#include "pipeline/person/face/face_votes.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::person {

struct FaceTrackParameters {
  int max_missed = 3;
  int min_agreeing = 2;
  int ask_again_images = 15;
  int ask_again_unsure_images = 6;
  double min_sure_confidence = 0.75;
  int max_comparisons = 5;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("max_missed", self.max_missed, Range{1, 30}, "",
                 "A face that was looked for and not found so many times in a row is gone.");
    visit.number("min_agreeing", self.min_agreeing, Range{1, 3}, "",
                 "A face has a name, or is a stranger's, when so many of its last three comparisons agree.");
    visit.number("ask_again_images", self.ask_again_images, Range{1, 300}, "",
                 "A face that has a name is compared again after this many images.");
    visit.number("ask_again_unsure_images", self.ask_again_unsure_images, Range{1, 300}, "",
                 "After this many where it is not yet sure.");
    visit.number("min_sure_confidence", self.min_sure_confidence, Range{0.5, 1.0}, "",
                 "The confidence from which on a name is sure: above that of a shirt, which overrules a less sure face "
                 "(Alg. 6.1). A face that is neither the person's of interest nor nearest to that person's counts "
                 "under its own name from there on, below it as not the person's.");
    visit.number(
        "max_comparisons", self.max_comparisons, Range{1, 30}, "",
        "At most so many faces are compared in 30 images, a second: what recognition costs beside the frame path.");
  }

  /// \return what is wrong with the keys together; empty when nothing is.
  [[nodiscard]] std::string inconsistency() const {
    return ask_again_unsure_images > ask_again_images ? "ask_again_unsure_images is larger than ask_again_images: a "
                                                        "face that is not sure is compared more often"
                                                      : "";
  }
};

/// A face that is followed from image to image.
struct FaceTrack {
  std::uint32_t number = 0;  ///< never given again.
  Box box;                   ///< where it was seen last, in pixels of the image.
  bool seen = false;         ///< in this image.
  int missed = 0;            ///< looks in a row that did not find it.
  std::optional<FaceMatch> match =
      std::nullopt;  ///< whose it is; nothing: not known yet. A match without a label: a stranger's.

 private:
  friend class FaceTracks;
  FaceVotes votes_;
  int looks_waited_ = 0;   // since it was looked for
  int images_waited_ = 0;  // since it was compared
  int compared_ = 0;       // so often
};

/// The faces in view: each is looked for near its last place, what is left of the budget goes on with the search through the whole image (6.2.1), and
/// each is named by comparisons beside the frame path that have to agree.
///
/// Threads: one. The detector allocates in every call.
class FaceTracks {
 public:
  static constexpr std::size_t kMaxFaces = 4;  ///< the face that was lost longest ago gives way to a new one.

  explicit FaceTracks(FaceDetector detector, const FaceTrackParameters& parameters = {});

  /// Looks for faces: one unit of the budget for each known face, those first that waited longest, one for where a face is expected and none is known,
  /// and one for each step of the search for others, which takes its turn first when it got none for some images.
  /// \param expected  where the face of somebody would be who is known by something else; nothing: nowhere.
  void look(const ImageView& image, WorkBudget& budget, const std::optional<Box>& expected = std::nullopt);
  /// An image in which known faces are not looked for: one step of the search for others.
  void pass(const ImageView& image, WorkBudget& budget);

  /// \return the crop of the seen face whose name is most wanted; nothing: none is wanted now, or no more may be compared yet.
  [[nodiscard]] std::optional<FaceQuestion> question(const ImageView& image) const;
  /// The question of this face was taken.
  void asked(std::uint32_t face);
  /// An answer of the recogniser; of a face that is gone: ignored.
  void hear(const FaceAnswer& answer);

  [[nodiscard]] std::span<const FaceTrack> tracks() const { return tracks_; }

 private:
  void look_for(FaceTrack& track, const ImageView& image);
  void age();
  void expect(const ImageView& image, const Box& expected);
  void forget_lost();
  void search(const ImageView& image);
  void add(const Box& face);
  static bool is_new(const FaceTrack& track);
  [[nodiscard]] double overdue(const FaceTrack& track) const;
  [[nodiscard]] FaceTrack* longest_waiting();

  FaceDetector detector_;
  FaceTrackParameters parameters_;
  std::vector<FaceTrack> tracks_;
  std::vector<Box> found_;
  std::int64_t images_ = 0;
  std::vector<std::int64_t> asked_at_;  // the images of the last max_comparisons questions, the oldest at next_asked_
  std::size_t next_asked_ = 0;
  int looks_without_search_ = 0;
  std::size_t looks_at_expected_ = 0;  ///< where a face was expected and none known.
  std::uint32_t next_number_ = 1;
};

}  // namespace cgsr::person
