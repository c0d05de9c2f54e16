#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/gpiod/line_access.h"
#include "hal/switches.h"
#include "platform/clock.h"
#include "platform/time.h"

namespace cgsr::hal::gpiod {

/// The least time between two requests of lines that are gone: looking for a line opens every chip.
inline constexpr Duration kLineWait = seconds(0.5);

/// General-purpose lines of this computer as switches.
///
/// The safe value of an output is off, whichever level that is: it is driven from the request on, when an output does
/// not answer (every output then goes off, the others too), and before the lines are given back. After a kill the chip
/// decides: an output that matters needs a resistor.
///
/// A line that does not answer, because its chip was unplugged for instance, is given back; the others are kept. Whenever
/// a line is used, but no sooner than kLineWait after the last attempt, those that are gone are requested again. An
/// output is requested again only after a set() has failed, so that nobody takes a lamp for lit that went out meanwhile.
/// A chip may come back under another number: lines of one that can be unplugged are wished for by their own names.
class GpiodSwitches final : public Switches {
 public:
  /// \param lines  without duplicates. \param access  not null; make_line_access() for the kernel's.
  /// \param clock  paces the requests of lines that are gone; outlives the lines.
  GpiodSwitches(std::vector<LineWish> lines, std::unique_ptr<LineAccess> access, const Clock& clock);
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
    std::optional<int> handle;  ///< nothing: the line is gone, or not started.
    bool on = false;            ///< of an output: what was last set.
    bool reported = false;      ///< that it is gone.
  };

  Result<Line*> find(std::string_view name);
  tl::unexpected<Error> lost(Line& line, int error);
  void give_back(Line& line);
  void give_back_outputs_that_do_not_answer();
  void request_again();
  void all_off();

  std::vector<Line> lines_;
  std::unique_ptr<LineAccess> access_;
  const Clock& clock_;
  bool started_ = false;
  std::string why_gone_;  ///< the errno of a line that does not answer, or what its last request came to.
  MonoTime next_request_{};
};

}  // namespace cgsr::hal::gpiod
