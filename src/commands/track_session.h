#pragma once

#include <optional>
#include <string>

#include "pipeline/color/learn/color_model.h"
#include "platform/box.h"
#include "platform/error.h"
#include "platform/image_lease.h"
#include "src/config/color.h"
#include "src/input/image_input.h"
#include "src/output/overlay.h"
#include "src/output/text_file.h"
#include "src/output/video_writer.h"
#include "src/scoring/scoring.h"

namespace cgsr::app {

/// The command line of `cgsr track`; empty texts were not given.
struct TrackOptions {
  std::string input;
  std::string learn;
  int learn_frame = 0;
  std::string model;
  std::string truth;
  std::string csv;
  std::string video;
  std::string json;
  std::string config;
  std::string mode;
  std::string scale_to;
  bool force = false;
};

/// Everything that is opened before the first image is looked at, so that what cannot be written or read is said at once.
struct Session {
  config::Color config;
  std::optional<ImageInput> input;
  std::optional<Boxes> truth;
  std::optional<TextFile> csv;
  std::optional<VideoWriter> video;
  std::optional<Overlay> overlay;
};

/// \return what is open, or the first thing that is not, in words.
Result<Session> open_session(const TrackOptions& options);

/// What is to be tracked.
struct Begun {
  color::ColorModel model;
  std::optional<ImageLease> learned_from;  ///< empty: the model came from a file.
  Box box;                                 ///< of the object in `learned_from`.
  std::string message;                     ///< for the person who asked.
};

/// Learns from the session's next image, or loads the model that was named.
Result<Begun> learn_or_load(const TrackOptions& options, Session& session);

}  // namespace cgsr::app
