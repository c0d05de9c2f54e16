#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hal/switches.h"

namespace cgsr::hal {

enum class LineDirection : std::uint8_t { kOutput, kInput };
std::string_view to_string(LineDirection direction);

struct DummyLine {
  std::string name;
  LineDirection direction = LineDirection::kOutput;
  bool on = false;  ///< of an input: what it reads until press().
};

/// Lines that exist in memory only: outputs remember what was set, inputs read what was pressed.
///
/// Threads: as Switches; press() and level() from any.
class DummySwitches final : public Switches {
 public:
  explicit DummySwitches(std::vector<DummyLine> lines) : lines_(std::move(lines)) {}

  /// \return an error that names the line when a name is empty or there twice.
  Result<void> start() override;
  [[nodiscard]] std::vector<std::string> names() const override;
  Result<void> set(std::string_view name, bool on) override;
  Result<bool> read(std::string_view name) override;
  void stop() override;

  /// Plays the world: sets an input. \return false when there is none of that name.
  bool press(std::string_view name, bool on);
  /// \return what a meter at the line would show, started or not; off when there is none of that name.
  [[nodiscard]] bool level(std::string_view name) const;

 private:
  Result<DummyLine*> find(std::string_view name, std::string_view purpose);
  void release_outputs();

  mutable std::mutex mutex_;
  std::vector<DummyLine> lines_;
  bool started_ = false;
};

}  // namespace cgsr::hal
