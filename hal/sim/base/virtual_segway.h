#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "hal/sim/base/simulated_rmp.h"
#include "hal/sim/base/virtual_can_bus.h"

namespace cgsr::sim {

/// A simulated Segway on its bus. Whoever comes first, the driver that receives or the camera that asks for the truth,
/// makes it catch up with the time.
class VirtualSegway {
 public:
  VirtualSegway(const BaseParameters& parameters, const BasePlacement& placement,
                std::vector<BaseEvent> base_script = {}, std::vector<BusEvent> bus_script = {})
      : bus_(std::move(bus_script)), base_(bus_.base(), parameters, placement, std::move(base_script)) {
    bus_.before_host_receives([this](MonoTime time) { base_.advance_to(time); });
  }
  VirtualSegway(const VirtualSegway&) = delete;
  VirtualSegway& operator=(const VirtualSegway&) = delete;

  /// \return the robot computer's end of the bus. The Segway must outlive it.
  std::unique_ptr<hal::CanBus> host_port() { return bus_.host(); }

  [[nodiscard]] VirtualCanBus& bus() { return bus_; }
  [[nodiscard]] SimulatedRmp& base() { return base_; }

 private:
  VirtualCanBus bus_;
  SimulatedRmp base_;
};

}  // namespace cgsr::sim
