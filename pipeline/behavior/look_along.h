#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "pipeline/behavior/drive_limits.h"
#include "pipeline/behavior/look_along_parameters.h"
#include "pipeline/behavior/name_votes.h"
#include "pipeline/behavior/velocity.h"
#include "platform/time.h"

namespace cgsr::behavior {

/// A face in an image.
struct FaceAtBearing {
  double bearing_rad = 0.0;  ///< from the camera's axis, positive to the left.
  bool compared = false;     ///< whether it is known whose it is.
  int number = 0;            ///< whose; 0: a stranger's.
  double confidence = 0.0;   ///< of that.
};

/// Somebody in the line.
struct PersonInLine {
  double bearing_rad = 0.0;  ///< from the robot's first direction, positive to the left.
  int number = 0;            ///< 0: a stranger.
  double confidence = 0.0;   ///< the share of the images in which he was taken for that person, weighted by confidence.
};

enum class LookAlongState : std::uint8_t { kTurningAside, kLooking, kStanding, kTelling, kDone };
std::string_view to_string(LookAlongState state);

struct LookAlongDecision {
  Velocity goal;
  LookAlongState state = LookAlongState::kTurningAside;
  int place = 0;                                    ///< of who is told of, 1 for the leftmost.
  std::optional<PersonInLine> told = std::nullopt;  ///< who is told of in this image.
};

/// Looks along a line of people (6.4.1.2, phase one): turns to the left end, then slowly to the right, stands before each face until it is named often
/// enough, and tells at the end who stands where, one in an image. In a line everybody is once: where two were taken for the same person, the less sure
/// one is a stranger.
///
/// Threads: one. Allocates nothing.
class LookAlong {
 public:
  static constexpr std::size_t kMaxPeople = 16;  ///< further ones are not noticed.

  LookAlong(const LookAlongParameters& parameters, const DriveLimits& limits)
      : parameters_(parameters), limits_(limits) {}

  /// \param faces  of this image.  \param heading_rad  of the robot when it was exposed, from any fixed direction; nothing: not known, the
  ///     robot stands and nobody is noticed.  \param elapsed  since the last image.
  LookAlongDecision decide(std::span<const FaceAtBearing> faces, std::optional<double> heading_rad, Duration elapsed);

 private:
  struct Met {
    double bearing_rad = 0.0;
    double waited_s = 0.0;  // before this one
    NameVotes votes{};
  };

  bool note(std::span<const FaceAtBearing> faces, double elapsed_s);
  Met* met_at(double bearing_rad);
  void settle();
  LookAlongDecision tell();

  LookAlongParameters parameters_;
  DriveLimits limits_;
  LookAlongState state_ = LookAlongState::kTurningAside;
  std::optional<double> first_heading_rad_;
  double heading_rad_ = 0.0;  // from the first direction
  double rate_radps_ = 0.0;
  std::array<Met, kMaxPeople> met_{};
  std::size_t met_count_ = 0;
  std::array<PersonInLine, kMaxPeople> line_{};
  std::size_t line_count_ = 0;
  std::size_t told_ = 0;
};

}  // namespace cgsr::behavior
