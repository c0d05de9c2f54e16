#pragma once

#include <functional>
#include <optional>

#include "hal/simulation.h"
#include "src/sinks/ground_truth.h"
#include "src/sinks/object_truth.h"
#include "src/sinks/pose_truth.h"
#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// Error of the lamp that was located, by the one that burns.
struct LampTruthStatistics {
  std::uint64_t compared = 0;  ///< images in which a lamp was known and one burnt.
  double mean_m = 0.0;
  double worst_m = 0.0;
  double last_m = 0.0;
};

/// Gets every image with what the robot made of it and what was really there. In lock-step what a report points to is still there.
using FrameObserver =
    std::function<void(const ImageView& image, const ImageReport& report, const std::optional<hal::ImageTruth>& truth)>;

/// Judges a simulated run by what was really there. It stands outside the robot: no stage, no task and no other sink knows the simulator.
class TruthSink final : public Sink {
 public:
  /// \param simulation  outlives the sink. \param set_distance_m  that the robot shall keep from its object; 0: it follows none.
  /// \param observer  may be empty.
  TruthSink(const hal::Simulation& simulation, double set_distance_m, FrameObserver observer)
      : simulation_(simulation),
        set_distance_m_(set_distance_m),
        observer_(std::move(observer)),
        object_(set_distance_m) {}

  Result<void> on_image(const ImageReport& report) override;
  void summarize(Summary& summary) override;

  /// Of the image at hand, for the sinks after this one.
  [[nodiscard]] const GroundTruth& ground_truth() const { return ground_truth_; }
  [[nodiscard]] const std::optional<hal::ImageTruth>& image_truth() const { return truth_; }
  [[nodiscard]] const LampTruthStatistics& lamp() const { return lamp_; }

 private:
  void judge_lamp(const stages::LampReport& lamp);

  const hal::Simulation& simulation_;
  double set_distance_m_;
  FrameObserver observer_;
  std::optional<hal::ImageTruth> truth_;
  GroundTruth ground_truth_;
  ObjectTruth object_;
  PoseTruth pose_;
  LampTruthStatistics lamp_;
};

}  // namespace cgsr::sinks
