#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/gpiod/line_access.h"
#include "hal/switches.h"

namespace cgsr::hal::gpiod {

/// General-purpose lines of this computer as switches.
///
/// The safe value of an output is off, whichever level that is: it is driven from the request on, when a line does not
/// answer (every output then goes off, the others too), and before the lines are given back. After a kill the chip
/// decides: an output that matters needs a resistor.
class GpiodSwitches final : public Switches {
 public:
  /// \param lines  without duplicates. \param access  not null; make_line_access() for the kernel's.
  GpiodSwitches(std::vector<LineWish> lines, std::unique_ptr<LineAccess> access);
  ~GpiodSwitches() override;
  GpiodSwitches(const GpiodSwitches&) = delete;
  GpiodSwitches& operator=(const GpiodSwitches&) = delete;

  Result<void> start() override;
  [[nodiscard]] std::vector<std::string> names() const override;
  Result<void> set(std::string_view name, bool on) override;
  Result<bool> read(std::string_view name) override;
  void stop() override;

 private:
  struct Line {
    LineWish wish;
    int handle = -1;
    bool on = false;  ///< of an output: what was last set.
  };

  Result<Line*> find(std::string_view name);
  void all_off();

  std::vector<Line> lines_;
  std::unique_ptr<LineAccess> access_;
  bool started_ = false;
};

}  // namespace cgsr::hal::gpiod
