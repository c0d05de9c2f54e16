#pragma once

#include <cstdint>
#include <string_view>

#include <tl/expected.hpp>

#include "hal/can_bus.h"
#include "hal/rmp/messages.h"

namespace cgsr::hal::rmp {

// Frames <-> messages, and nothing else: no units, no state, no time.
//
// A payload is four 16-bit slots, each big-endian: slot n lies in bytes 2n, 2n + 1. A 32-bit value takes two slots, the
// low one first.

enum class DecodeFailure : std::uint8_t {
  kUnknownId,  ///< of another family, or of a later one (0x0500..: RMP 210/220/440).
  kWrongSize,  ///< every message but the shutdown has eight bytes.
};
std::string_view to_string(DecodeFailure failure);

/// \return what the frame says. Never fails on the contents: whether a value is plausible is for the driver to judge.
tl::expected<Message, DecodeFailure> decode(const CanFrame& frame);

/// \return the frame 0x0413, its stamp unset.
CanFrame encode(const Command& command);

}  // namespace cgsr::hal::rmp
