#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/sim/base/virtual_segway.h"
#include "hal/sim/cache.h"
#include "hal/sim/home/scenario.h"
#include "hal/sim/switches/simulated_switches.h"
#include "hal/sim/worlds/world.h"
#include "hal/simulation.h"

namespace cgsr::sim {

/// The simulated home in one piece: the world's scripts, the Segway on its bus, the lines, and the camera that rides on
/// the Segway's body and nods with it.
///
/// An image is drawn from the world in the middle of its exposure (or from several moments of it). It waits for nobody:
/// what time it is, advance_to() and the stamps say.
class SimulatedHome final : public hal::Simulation {
 public:
  /// \return the home, or every problem of scenario and world, a line each.
  static Result<std::unique_ptr<SimulatedHome>> make(const hal::SimulationParameters& parameters);

  std::unique_ptr<hal::Camera> take_camera() override;
  std::unique_ptr<hal::CanBus> take_can_bus() override { return segway_.host_port(); }
  std::unique_ptr<hal::Switches> take_switches() override;
  [[nodiscard]] Duration image_delay() const override { return image_delay_; }
  void advance_to(MonoTime time) override;
  [[nodiscard]] std::optional<hal::ImageTruth> truth(MonoTime stamp) const override;
  [[nodiscard]] const hal::Plan& plan() const override { return plan_; }
  [[nodiscard]] std::vector<std::string> notes() const override;

  /// For tests: the base, the bus and the lines behind the interfaces.
  VirtualSegway& segway() { return segway_; }
  SimulatedSwitches& switches() { return *switches_; }

  /// The world at a time as the robot's camera would see it.
  Moment moment_at(MonoTime time);

 private:
  static constexpr std::size_t kTruthsKept = 64;

  SimulatedHome(const hal::SimulationParameters& parameters, Scenario scenario, World world);

  Result<void> open_camera();
  void take_image(std::uint64_t number, MonoTime stamp, const YuyvBuffer& buffer);
  void remember(MonoTime stamp, MonoTime middle, const Moment& moment);
  [[nodiscard]] SwitchStates switched_at(double time_s) const;

  hal::SimulationParameters parameters_;
  Scenario scenario_;
  World world_;
  std::size_t robot_ = 0;          // of the scene
  int object_ = -1;                // figure of the scene; -1: nobody is followed
  std::vector<int> object_parts_;  // those that count; none: all
  VirtualSegway segway_;
  std::shared_ptr<SimulatedSwitches> switches_;
  CameraModel camera_;
  SensorSettings sensor_;
  Duration image_delay_{};
  std::atomic<MonoTime> now_{MonoTime{}};
  std::unique_ptr<CachedPhotographer> photographer_;
  hal::Plan plan_;
  mutable std::mutex truth_mutex_;
  std::deque<hal::ImageTruth> truths_;
};

}  // namespace cgsr::sim
