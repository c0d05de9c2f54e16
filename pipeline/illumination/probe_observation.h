#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "pipeline/illumination/board.h"
#include "pipeline/illumination/cone_strip.h"
#include "pipeline/illumination/registration.h"
#include "pipeline/illumination/shadow_lines.h"
#include "platform/image_view.h"
#include "platform/parameters.h"

namespace cgsr::illumination {

/// Section [probes] of a robot's file: the board and how it is looked at.
struct ProbesParameters {
  BoardParameters board;
  RegistrationParameters registration;
  ShadowParameters shadow;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("board", self.board, "The white board with its cones, as measured, in the robot's frame");
    visit.section("registration", self.registration,
                  "The estimation of the camera's pose relative to the board in every image");
    visit.section("shadow", self.shadow, "The cones' shadows (Alg. 5.1)");
  }
};

/// Whether an image shows a shadow of the probes; else why not.
enum class ObservationStatus : std::uint8_t {
  kSeen,           ///< at least one shadow.
  kNoShadow,       ///< the board is there, and no probe casts a shadow that can be seen.
  kNoImage,        ///< none, or in a form that has no brightness.
  kWrongSize,      ///< not the size that the camera was calibrated for.
  kNotRegistered,  ///< board and cones are not where the calibration says, or not to be seen.
  kSaturated,      ///< the board is brighter than the camera holds.
};
std::string_view to_string(ObservationStatus status);

/// What one image tells about lamps.
struct ProbeObservation {
  ObservationStatus status = ObservationStatus::kNoImage;
  Registration registration;
  std::array<ShadowFinder::Found, kMostProbes> probe;  ///< the shadows of each.
  int missing = 0;                                     ///< bit i: probe i stands on the board, but was not found.
  int saturated =
      0;  ///< bit i: the board about probe i is brighter than the camera holds; its shadow may not be found.
};

/// Looks at the probes in every image : the board first, then each probe's surroundings, which follow from the board's geometry and not from
/// constants. Works on a YUYV or grey image as it lies there (Alg. 5.1) and allocates nothing after construction.
///
/// Threads: one.
class ProbeObserver {
 public:
  /// \param lamp_height_m  of a lamp above the board, roughly.
  ProbeObserver(const Board& board, const ProbesParameters& parameters, double lamp_height_m);

  ProbeObservation observe(const ImageView& image);

  [[nodiscard]] const Board& board() const { return board_; }
  /// Forget the last image: the next one is searched from the mount on.
  void restart() { has_last_ = false; }

 private:
  int look_beside_cones(const LumaView& luma, ProbeObservation& observation);

  Board board_;
  ProbesParameters parameters_;
  std::vector<ShadowFinder> finders_;
  std::vector<ConeStrip> strips_;
  geometry::Pose last_X_BC_ = geometry::Pose::Identity();
  bool has_last_ = false;
};

}  // namespace cgsr::illumination
