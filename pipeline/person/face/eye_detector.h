#pragma once

#include <memory>
#include <string>

#include "pipeline/person/face/grey_region.h"
#include "platform/error.h"

namespace cgsr::person {

class Cascade;

/// Whether what was taken for a face has an eye: the back of a head in the light of a lamp, or a pattern, is taken for one now and then, and would be
/// a stranger's face, for it is like nobody's. OpenCV's cascade for eyes (Castrillon et al., 2007). Ours; the dissertation asks nothing of a face.
///
/// Threads: one. It allocates in every call.
class EyeDetector {
 public:
  /// \param cascade_xml  the text of a cascade's file.  \return an error that says what is wrong with the text.
  static Result<EyeDetector> from_cascade(const std::string& cascade_xml);
  EyeDetector(EyeDetector&&) noexcept;
  EyeDetector& operator=(EyeDetector&&) noexcept;
  ~EyeDetector();

  /// \param crop  as face_crop() cuts it; in anything else there is no eye.
  /// Cost: 20 million instructions.
  [[nodiscard]] bool has_eye(const GreyPatch& crop);

 private:
  explicit EyeDetector(std::unique_ptr<Cascade> cascade);

  std::unique_ptr<Cascade> cascade_;
};

}  // namespace cgsr::person
