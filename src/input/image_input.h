#pragma once

#include <memory>
#include <string>

#include "hal/camera.h"
#include "hal/replay/replay_camera.h"
#include "platform/box.h"
#include "platform/error.h"

namespace cgsr::app {

/// Which images a command line names.
struct InputOptions {
  std::string path;
  int first = 0;
  int count = 0;     ///< 0: to the end.
  int width_px = 0;  ///< scale to this size; 0: as stored.
  int height_px = 0;
};

/// A video, image folder or image, opened, started and read as fast as it decodes.
class ImageInput {
 public:
  static Result<ImageInput> open(const InputOptions& options);

  [[nodiscard]] const hal::CameraMode& mode() const { return mode_; }
  [[nodiscard]] const std::vector<std::string>& notes() const { return camera_->notes(); }

  /// What next() came back with: an image, a refused image (why stands in `problem`), or the end (`problem`: what ended it early, if anything).
  struct Next {
    ImageLease image;
    std::string problem;
    bool end = false;
  };
  Next next();

 private:
  ImageInput(std::unique_ptr<hal::ReplayCamera> camera, const hal::CameraMode& mode)
      : camera_(std::move(camera)), mode_(mode) {}

  std::unique_ptr<hal::ReplayCamera> camera_;
  hal::CameraMode mode_;
  std::string told_;  ///< the problem of the last refused image: the camera remembers it until there is another.
};

/// Reads `640x480`. \return an error that repeats the text.
Result<std::pair<int, int>> parse_size(const std::string& text);

/// Reads `X,Y,W,H` in pixels. \return an error that repeats the text.
Result<Box> parse_box(const std::string& text);

}  // namespace cgsr::app
