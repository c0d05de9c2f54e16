#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "hal/can_bus.h"

namespace cgsr::test {

/// candump notation: 413#00A600EA00000000. For literals in tests: what is not hexadecimal throws.
inline hal::CanFrame frame(std::string_view text) {
  hal::CanFrame frame;
  frame.id = static_cast<std::uint16_t>(std::stoul(std::string(text.substr(0, 3)), nullptr, 16));
  for (std::string_view rest = text.substr(4); !rest.empty(); rest = rest.substr(2)) {
    frame.data.at(frame.size++) = static_cast<std::uint8_t>(std::stoul(std::string(rest.substr(0, 2)), nullptr, 16));
  }
  return frame;
}

inline std::string candump(const hal::CanFrame& frame) {
  std::string text = fmt::format("{:03X}#", frame.id);
  for (std::size_t i = 0; i < frame.size; ++i) text += fmt::format("{:02X}", frame.data[i]);
  return text;
}

/// Whole numbers of [least, most], the same on every machine and library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::int64_t whole(std::int64_t least, std::int64_t most) {
    return least + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(most - least + 1));
  }
  double real(double least, double most) {
    return least + (most - least) * static_cast<double>(engine_() >> 11) * 0x1.0p-53;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace cgsr::test
