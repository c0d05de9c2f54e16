#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/track/light_history.h"
#include "pipeline/imaging/reduce.h"
#include "pipeline/stages/color_stages.h"
#include "src/commands/track_session.h"

namespace cgsr::app {

/// Tracks through a session's images, writes what was asked for and keeps what was found.
class TrackRun {
 public:
  /// \param first_frame  number of the image that comes first.
  TrackRun(Session session, color::ColorModel model, stages::ColorLoop loop, std::uint64_t first_frame);

  // Each of these is one image further; an error is a file that could not be written.

  /// The image that was learned from: its box is known. Counts as image number one of the output, but never as an answer.
  Result<void> begin_with(const ImageLease& image, const Box& box);
  Result<void> track(const ImageLease& image);
  /// An image that could not be read: nothing is found in it, and the numbering goes on.
  Result<void> miss();

  /// After the last image: what the video still holds is written. \return an error when it could not be.
  Result<void> finish();

  [[nodiscard]] int images() const { return asked_; }
  [[nodiscard]] int found() const { return found_; }
  /// The images from which on the object was not found, and those in which it was found again.
  [[nodiscard]] const std::vector<std::uint64_t>& losses() const { return losses_; }
  [[nodiscard]] const std::vector<std::uint64_t>& reacquisitions() const { return reacquisitions_; }
  [[nodiscard]] std::uint64_t frame() const { return frame_; }
  [[nodiscard]] const config::Color& config() const { return session_.config; }
  [[nodiscard]] ImageInput& input() { return *session_.input; }

  /// After the last image. \return an error when there is a truth, read from `path`, of another length.
  [[nodiscard]] Result<void> check_truth(const std::string& path) const;

  /// Over the images from `first_answer` on that were looked at; nothing without a truth.
  [[nodiscard]] std::optional<Score> score(std::uint64_t first_answer) const;

 private:
  Result<void> keep(const ImageLease& image, const color::TrackedObject& object);
  Result<void> draw(const ImageLease& image, const color::TrackedObject& object,
                    const std::optional<color::Light>& plurality);
  void note_change(bool found);
  Result<void> write_row(const color::TrackedObject& object);

  Session session_;
  color::ColorModel model_;
  stages::ColorLoop loop_;
  color::LightHistory history_;
  Boxes boxes_;
  std::uint64_t frame_;
  int asked_ = 0;
  int found_ = 0;
  bool seen_ = false;        ///< it was found in an image before,
  bool found_last_ = false;  ///< and in the last one.
  std::vector<std::uint64_t> losses_;
  std::vector<std::uint64_t> reacquisitions_;
};

}  // namespace cgsr::app
