#pragma once

#include <cstdint>
#include <optional>

#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/face/grey_region.h"

namespace cgsr::person {

/// A face that is to be named.
struct FaceQuestion {
  std::uint32_t face = 0;  ///< the number of its track.
  GreyPatch crop;          ///< as face_crop() cuts it.
};

/// Whose face it is.
struct FaceAnswer {
  std::uint32_t face = 0;
  FaceMatch match;
};

/// Describes the face in a crop and compares it with everybody's (6.2.1). The detector's box is up to a third too small or too large, and a face that lies
/// otherwise in it than the enrolled ones do is far from everybody: there it is cut once more, as they lie, and that is compared. As all of them lie in the
/// mean, not as the nearest: laid onto one person's face, a stranger's becomes more like that one and not like the others. Ours.
///
/// \param crop  as face_crop() cuts it; anything else is a stranger's.  \param without  as in FaceGallery::identify().
/// Cost: 30 million instructions and half a million for each view in the gallery; twice that where it is cut once more.
FaceMatch identify_crop(const GreyPatch& crop, const FaceGallery& gallery, std::optional<Label> without = std::nullopt);

/// Names the face of a question. Cost: as identify_crop().
FaceAnswer recognize(const FaceQuestion& question, const FaceGallery& gallery);

/// Where the frame path has faces named: beside it, because describing a face costs a third of an image's time. Whoever asks goes on and looks
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
  SteppedRecognizer(FaceGallery gallery, int images) : gallery_(std::move(gallery)), images_(images) {}

  bool ask(FaceQuestion&& question) override;
  std::optional<FaceAnswer> answer() override;

 private:
  FaceGallery gallery_;
  int images_;
  std::optional<FaceQuestion> question_;
  int images_left_ = 0;
};

}  // namespace cgsr::person
