#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pipeline/illumination/active_check.h"
#include "platform/time.h"

namespace cgsr::stages {

/// The lamps that the robot may switch.
enum class LampLine : std::uint8_t {
  kProbeLamp,  ///< shines on the probe board.
  kRoomLamp,   ///< the one whose shadows are looked for.
  kFillLight,  ///< on faces, under the camera (6.4.1.1).
};
inline constexpr std::size_t kLampLines = 3;
std::string_view to_string(LampLine line);

/// What vision asks of the switch worker, and what that answers.
struct SwitchRequest {
  LampLine line = LampLine::kProbeLamp;
  bool on = false;
  std::uint32_t number = 0;  ///< counts requests from 1; the answer repeats it.
  MonoTime asked_at{};
};
struct SwitchAnswer {
  SwitchRequest request;
  bool done = false;  ///< else the line did not answer.
  MonoTime at{};      ///< when it was acknowledged.
};

/// Turns what stages want of lamps into one switching at a time for each line, and says which images show the result: the first whose exposure
/// begins a frame period or more after the acknowledged change. A line that does not answer, or not in time, is silent from then on: it is asked a
/// few times more to go back to what is wanted, and never trusted again.
///
/// Time is that of the images' stamps. Threads: one, vision's; nothing is allocated.
class Switchboard {
 public:
  /// No line is there.
  Switchboard() = default;
  Switchboard(const std::array<bool, kLampLines>& there, Duration frame_period, Duration answer_within);

  /// From now on the line should have that level. Without the line: nothing.
  void want(LampLine line, bool on);
  /// \return the next switching that is due. To be asked until it has none.
  std::optional<SwitchRequest> next(MonoTime now);
  void on_answer(const SwitchAnswer& answer);

  /// \return the line as an image with that stamp shows it.
  [[nodiscard]] illumination::LineState state(LampLine line, MonoTime stamp) const;

 private:
  static constexpr int kMostTries = 3;

  struct Line {
    bool there = false;
    bool wanted = false;
    bool on = false;
    bool silent = false;
    std::uint32_t under_way = 0;  // number of the request that has no answer yet; 0: none
    int tries = 0;                // in a row without success
    MonoTime asked_at{};
    std::optional<MonoTime> changed_at;  // nothing: never switched
  };
  [[nodiscard]] Line& of(LampLine line) { return lines_[static_cast<std::size_t>(line)]; }
  [[nodiscard]] const Line& of(LampLine line) const { return lines_[static_cast<std::size_t>(line)]; }

  std::array<Line, kLampLines> lines_{};
  Duration frame_period_{};
  Duration answer_within_{};
  std::uint32_t requests_ = 0;
};

}  // namespace cgsr::stages
