#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/person/face/eye_detector.h"
#include "pipeline/person/face/face_detector.h"
#include "pipeline/person/face/face_gallery.h"
#include "pipeline/person/identities.h"
#include "platform/error.h"
#include "src/input/image_input.h"
#include "src/output/text_file.h"

namespace cgsr::app {

/// Where Debian's opencv-data has the cascade of 6.2.1.
inline constexpr const char* kFaceCascade = "/usr/share/opencv4/haarcascades/haarcascade_frontalface_alt2.xml";
inline constexpr const char* kEyeCascade = "/usr/share/opencv4/haarcascades/haarcascade_eye.xml";

struct PeopleOptions {
  std::string identities;
  std::string name;
  std::string input;
  std::string csv;
  std::string cascade = kFaceCascade;
  std::string eye_cascade = kEyeCascade;  ///< empty: eyes are not looked for, nor dark faces.
  double min_face_px = person::FaceDetectorParameters{}.min_face_px;
  bool force = false;
  bool more = false;   ///< enroll: the person is known already, these are more views.
  bool alike = false;  ///< enroll: somebody else than those who are enrolled, however alike they are.
};

/// Finds the faces of single images: as they are, and where there is none, dark ones that have an eye.
class FaceSearch {
 public:
  /// \return an error that names the file and Debian's package.
  static Result<FaceSearch> open(const PeopleOptions& options);

  /// \param last  a face of the image before, where one is sought before dark ones are: whoever is enrolled hardly moves.
  std::vector<Box> find(const ImageView& image, const std::optional<Box>& last = std::nullopt);
  /// \return whether it has an eye; true where eyes are not looked for.
  bool has_eye(const person::GreyPatch& crop) { return !eyes_ || eyes_->has_eye(crop); }

 private:
  FaceSearch(person::FaceDetector detector, std::optional<person::EyeDetector> eyes)
      : detector_(std::move(detector)), eyes_(std::move(eyes)) {}

  person::FaceDetector detector_;
  std::optional<person::EyeDetector> eyes_;
};

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
/// A damaged identities file is put aside then (IdentitiesEdit).
Result<Enrolled> enroll(const PeopleOptions& options);

/// What forget() leaves to be done.
struct Forgotten {
  std::vector<std::filesystem::path> copies;  ///< damaged files that were kept aside, and may hold the person still.
};

/// Takes a person out of the identities file. \return an error: there is nobody of this name.
Result<Forgotten> forget(const PeopleOptions& options);

/// The work of `cgsr people identify`, an image at a time.
class IdentifyRun {
 public:
  static Result<IdentifyRun> open(const PeopleOptions& options);

  /// Writes the image's rows at once. \return false at the end of the images.
  Result<bool> step();

  [[nodiscard]] int images() const { return images_; }
  [[nodiscard]] int faces() const { return faces_; }
  /// For the terminal: how often each person was seen, by name.
  [[nodiscard]] std::vector<std::string> summary() const;

 private:
  IdentifyRun(PeopleOptions options, person::Identities identities, ImageInput input, FaceSearch search,
              std::optional<TextFile> csv);
  Result<void> add_row(const std::string& row);
  /// \return whether it is a face: what is nobody's and has no eye is none.
  Result<bool> add_face(const ImageView& image, const Box& face);

  PeopleOptions options_;
  person::Identities identities_;
  ImageInput input_;
  FaceSearch search_;
  person::FaceGallery gallery_;
  std::map<person::Label, int> seen_;  // 0: strangers
  std::optional<TextFile> csv_;
  std::vector<std::string> problems_;  // the first
  int unreadable_ = 0;
  int images_ = 0;
  int faces_ = 0;
};

}  // namespace cgsr::app
