#pragma once

#include <array>
#include <cstddef>

namespace cgsr::behavior {

/// The direction in which a followed object was and moved, of those sightings only that were followed by more of them: what was taken for the object
/// in the last moments before a loss, or for a few images after one, may have been a look-alike.
///
/// The bearing is added to the turn that was commanded, so that a robot that turns with the object still knows its motion. The rate is smoothed
/// over half a second.
/// Ours.
///
/// Nothing is allocated. Errors: none; with a confirm_s of more than kMaxPending images the oldest of them is confirmed early.
class ConfirmedMotion {
 public:
  static constexpr std::size_t kMaxPending = 256;

  explicit ConfirmedMotion(double confirm_s) : confirm_s_(confirm_s) {}

  /// Once per image, before seen() or lost(). \param left_radps  the turn rate commanded since the last image.
  void turned(double left_radps, double elapsed_s);

  /// The object was found at this bearing, positive to the left.
  void seen(double bearing_rad);

  /// The object is lost: what is not confirmed yet is dropped.
  void lost();

  [[nodiscard]] bool confirmed() const { return confirmed_; }
  /// Of the last confirmed sighting, as seen from the robot then. 0 when there is none.
  [[nodiscard]] double bearing_rad() const { return last_.bearing_rad; }
  /// How fast the direction to the object changed over a robot that stands, positive to the left.
  [[nodiscard]] double rate_radps() const { return rate_radps_; }

 private:
  struct Sighting {
    double time_s = 0.0;
    double bearing_rad = 0.0;
    double direction_rad = 0.0;  // the bearing and the robot's turn since the start
  };

  void confirm(const Sighting& sighting);

  double confirm_s_;
  double time_s_ = 0.0;
  double heading_rad_ = 0.0;
  std::array<Sighting, kMaxPending> pending_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  Sighting last_;
  double rate_radps_ = 0.0;
  bool confirmed_ = false;
  bool interrupted_ = false;  // since the last confirmed sighting
};

}  // namespace cgsr::behavior
