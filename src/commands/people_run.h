#pragma once

#include <map>
#include <string>
#include <vector>

#include "pipeline/person/face/face_detector.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/identities.h"
#include "platform/error.h"
#include "src/input/image_input.h"

namespace cgsr::app {

/// Where Debian's opencv-data has the cascade of 6.2.1.
inline constexpr const char* kFaceCascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml";

struct PeopleOptions {
  std::string identities;
  std::string name;
  std::string input;
  std::string csv;
  std::string cascade = kFaceCascade;
  double min_face_px = person::FaceDetectorParameters{}.min_face_px;
  bool force = false;
  bool more = false;   ///< enroll: the person is known already, these are more views.
  bool alike = false;  ///< enroll: somebody else than those who are enrolled, however alike they are.
};

/// Loads the detector. \return an error that names the file and Debian's package.
Result<person::FaceDetector> open_face_detector(const PeopleOptions& options);

/// What `cgsr people enroll` did.
struct Enrolled {
  person::Label number = 0;
  int images = 0;
  int with_one_face = 0;
  int views = 0;  ///< that the person has now.
  std::string note;
};

/// Enrols the person whose face is alone in each image of the input: of those faces, the ones that differ most from each other become views.
/// Images without a face or with several are left out. Of more views than can be kept the oldest go, but never the first. Written when all went well.
/// \return an error says also where a damaged identities file has been put (open_identities()).
Result<Enrolled> enroll(const PeopleOptions& options);

/// Takes a person out of the identities file. \return how many of this name there were; an error: none.
Result<int> forget(const PeopleOptions& options);

/// The work of `cgsr people identify`, an image at a time.
class IdentifyRun {
 public:
  static Result<IdentifyRun> open(const PeopleOptions& options);

  /// \return false at the end of the images.
  Result<bool> step();
  /// Writes the CSV.
  Result<void> finish() const;

  [[nodiscard]] int images() const { return images_; }
  [[nodiscard]] int faces() const { return faces_; }
  /// For the terminal: how often each person was seen, by name.
  [[nodiscard]] std::vector<std::string> summary() const;

 private:
  IdentifyRun(PeopleOptions options, person::Identities identities, ImageInput input, person::FaceDetector detector);
  void add_face(const ImageView& image, const Box& face);

  PeopleOptions options_;
  person::Identities identities_;
  ImageInput input_;
  person::FaceDetector detector_;
  person::FaceGallery gallery_;
  std::map<person::Label, int> seen_;  // 0: strangers
  std::vector<std::string> problems_;
  std::string rows_;
  int images_ = 0;
  int faces_ = 0;
};

}  // namespace cgsr::app
