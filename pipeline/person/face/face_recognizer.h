#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/person/context.h"
#include "pipeline/person/face/eye_detector.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/face/grey_region.h"

namespace cgsr::person {

/// A face that is to be named.
struct FaceQuestion {
  std::uint32_t face = 0;             ///< the number of its track.
  GreyPatch crop;                     ///< as face_crop() cuts it.
  double signal_to_noise = kNoNoise;  ///< of the face in the image.
};

/// Whose face it is.
struct FaceAnswer {
  std::uint32_t face = 0;
  FaceMatch match;
  bool counts = true;  ///< false: nothing is known of whose it is, for it may be no face.
};

/// Describes the face in a crop and compares it with everybody's (6.2.1). The detector's box is up to a third too small or too large, and a face that lies
/// otherwise in it than the enrolled ones do is far from everybody: there it is cut once more, as they lie, and that is compared. As all of them lie in the
/// mean, not as the nearest: laid onto one person's face, a stranger's becomes more like that one and not like the others. Ours.
///
/// \param crop  as face_crop() cuts it; anything else is a stranger's.  \param without  as in FaceGallery::identify().
/// Cost: 11 million instructions and half a million for each view in the gallery; twice that where it is cut once more.
FaceMatch identify_crop(const GreyPatch& crop, const FaceGallery& gallery, std::optional<Label> without = std::nullopt);

/// Names the faces of questions, and learns new views of who is followed: the training of a primary characteristic by one that is surer (Alg. 6.1). Here that
/// is the face's own past: whose it surely was a moment ago it still is, in another light or turned away, as long as it changes in small steps. A face that was
/// surely named twice in a row, is followed as one track and is no longer surely named, but nearest to the same person still, is learned where it is near
/// to how it was then: somebody else who comes before it is not. What is learned counts for that face alone, as long as it is followed: in one light all faces
/// are nearer to each other, and others would be nearer to that person than to everybody who was enrolled elsewhere. Ours; 6.2.4 leaves the training of faces out.
///
/// Bounded: kFaces faces are remembered, FaceMatchParameters::max_learned_views views of each. Threads: one, the recogniser's.
class FaceTrainer {
 public:
  static constexpr std::size_t kMaxEyeLooks = 2;  ///< in any five answers: what recognition costs has a bound.

  /// \param eyes  what has no eye is no stranger's face; nothing: eyes are not looked for.
  explicit FaceTrainer(FaceGallery gallery, std::optional<EyeDetector> eyes = std::nullopt)
      : gallery_(std::move(gallery)), eyes_(std::move(eyes)) {}

  /// Noise makes a face farther from everybody, its own views too: of one that hardly stands out of it, 'a stranger's' and 'nobody else's' are less sure.
  /// 'A stranger's' of what has not shown an eye in any crop of its track does not count, nor where no look for one may be made (kMaxEyeLooks). What a track goes
  /// over to after it has shown one counts.
  /// Cost: as identify_crop(), half a million instructions where the name is not sure, and EyeDetector's where it is clearly a stranger's and has not shown an eye yet.
  FaceAnswer answer(const FaceQuestion& question);

  /// \return how many views were learned of a face.
  [[nodiscard]] std::size_t learned(std::uint32_t face) const;

 private:
  static constexpr std::size_t kFaces = 8;
  struct Followed {
    std::uint32_t face = 0;  // number of its track; 0: none
    Label person = 0;        // whose it was
    int sure = 0;            // answers in a row
    bool has_eye = false;    // in one of its crops at least
    FaceView view{};         // how it was
    std::vector<FaceView> learned{};
  };
  Followed& followed(std::uint32_t face);
  bool has_eye(Followed& face, const GreyPatch& crop);
  void learn(Followed& face) const;

  FaceGallery gallery_;
  std::optional<EyeDetector> eyes_;
  static constexpr std::size_t kAnswers = 5;
  std::bitset<kAnswers> looked_for_eyes_;  // in this answer, the lowest, and the four before it
  std::array<Followed, kFaces> followed_{};
};

/// Where the frame path has faces named: beside it, because naming a face costs about an image's time. Whoever asks goes on and looks
/// for the answer in a later image. Ours; the dissertation (6.2.3) recognises on the frame path, in every other image.
///
/// Threads: one, which asks and reads the answers.
class FaceRecognizer {
 public:
  virtual ~FaceRecognizer() = default;

  /// Never blocks. \return whether the question was taken; if not, the recogniser is busy.
  virtual bool ask(FaceQuestion&& question) = 0;

  /// To be called once per image. \return an answer that has come; nothing: none has.
  virtual std::optional<FaceAnswer> answer() = 0;
};

/// Answers a fixed number of images after the question, whatever the machine takes for it: in lock-step the same images give the same answers.
class SteppedRecognizer final : public FaceRecognizer {
 public:
  /// \param images  at least 1.
  SteppedRecognizer(FaceTrainer trainer, int images) : trainer_(std::move(trainer)), images_(images) {}

  bool ask(FaceQuestion&& question) override;
  std::optional<FaceAnswer> answer() override;

 private:
  FaceTrainer trainer_;
  int images_;
  std::optional<FaceQuestion> question_;
  int images_left_ = 0;
};

}  // namespace cgsr::person
