#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hal/switches.h"
#include "platform/time.h"

namespace cgsr::sim {

struct SwitchLine {
  std::string name;
  bool is_input = false;
};

enum class SwitchHappening : std::uint8_t {
  kPressed,   ///< of an input: it reads on.
  kNoAnswer,  ///< setting and reading it fail, and change nothing.
  kStuck,     ///< of an output: setting it succeeds and changes nothing.
};

/// Something happens to a line from `from` until just before `to`.
struct SwitchEvent {
  SwitchHappening what = SwitchHappening::kPressed;
  std::string line;
  MonoTime from{};
  MonoTime to = MonoTime::max();
};

/// Lines of the simulated robot. A lamp of the scene burns as its line's level says, from the next image on.
///
/// Threads: as Switches; advance_to, level and press from any.
class SimulatedSwitches final : public hal::Switches {
 public:
  explicit SimulatedSwitches(std::vector<SwitchLine> lines, std::vector<SwitchEvent> script = {});

  /// \return an error that names the line when a name is empty or there twice, or the script names one that does not
  /// exist or of which that cannot happen.
  Result<void> start() override;
  [[nodiscard]] std::vector<std::string> names() const override;
  Result<void> set(std::string_view name, bool on) override;
  Result<bool> read(std::string_view name) override;

  /// A line that is stuck or does not answer goes off all the same: its driver lost power.
  void stop() override;

  /// The simulated time, which the script counts in. An earlier time changes nothing.
  void advance_to(MonoTime time);

  /// \return what a meter at the line shows, started or not; off when there is none of that name.
  [[nodiscard]] bool level(std::string_view name) const;

  /// Somebody moves an input by hand, beside the script. \return false when there is none of that name.
  bool press(std::string_view name, bool on);

 private:
  struct State {
    SwitchLine line;
    bool set = false;      // of an output: what was last asked for
    bool level = false;    // of an output: what came of it
    bool pressed = false;  // of an input, by hand
  };

  [[nodiscard]] const State* find(std::string_view name) const;
  [[nodiscard]] bool happens(SwitchHappening what, std::string_view name) const;
  [[nodiscard]] Result<void> usable(std::string_view name, std::string_view purpose) const;
  void all_off();

  mutable std::mutex mutex_;
  std::vector<State> lines_;
  std::vector<SwitchEvent> script_;
  MonoTime now_ = MonoTime::min();
  bool started_ = false;
};

}  // namespace cgsr::sim
