#pragma once

#include <cstdint>
#include <optional>

#include "hal/simulation.h"
#include "pipeline/color/track/tracker.h"
#include "pipeline/motion/motion_status.h"

namespace cgsr::sinks {

/// What a simulated run came to, measured by what was really there. Counts begin with the first image in which the robot
/// found the object; times are in steps of an image.
struct ObjectTruthStatistics {
  std::uint64_t images = 0;         ///< in which the object was there.
  std::uint64_t in_view = 0;        ///< of these: at least a pixel of it was seen.
  std::uint64_t found = 0;          ///< of these in turn: the robot found something.
  std::uint64_t found_right = 0;    ///< and what it found overlaps the truth (intersection over union >= 0.4).
  std::uint64_t found_nothing = 0;  ///< images in which the robot found what was not in view.
  double fastest_object_mps = 0.0;
  double min_distance_m = 0.0;  ///< from camera to object, however it came about; 0: never seen.

  /// Smallest distance over the set distance at a moment when the robot rolled forward and the object did not come
  /// nearer by itself.
  std::optional<double> nearest_by_own_motion;

  std::uint64_t losses = 0;  ///< times the object went out of view while the robot rolled forward.
  std::optional<double> longest_command_after_loss_s;  ///< until the command was not forward any more.
  std::optional<double> longest_roll_after_loss_s;     ///< until the robot stood (below 0.05 m/s).

  std::uint64_t nearings = 0;  ///< times the object by itself came nearer than the set distance.
  std::optional<double> longest_command_when_nearer_s;  ///< until the command was not forward any more.
};

/// Adds up the statistics, image by image.
class ObjectTruth {
 public:
  /// \param set_distance_m  that the robot shall keep, > 0.
  explicit ObjectTruth(double set_distance_m) : set_distance_m_(set_distance_m) {}

  void add(const hal::ImageTruth& truth, const color::TrackedObject& object, const MotionStatus& motion);

  [[nodiscard]] const ObjectTruthStatistics& statistics() const { return statistics_; }

 private:
  /// From an event until something is over.
  struct Wait {
    std::optional<MonoTime> since;
    void end_at(MonoTime now, std::optional<double>& longest);
  };

  void count(const hal::ImageTruth& truth, const color::TrackedObject& object);
  void watch_losses(const hal::ImageTruth& truth, bool commanded_forward);
  void watch_nearings(const hal::ImageTruth& truth, bool commanded_forward);

  double set_distance_m_;
  ObjectTruthStatistics statistics_;
  bool seen_ = false;
  bool was_in_view_ = false;
  bool was_nearer_ = false;
  Wait command_after_loss_;
  Wait roll_after_loss_;
  Wait command_when_nearer_;
};

}  // namespace cgsr::sinks
