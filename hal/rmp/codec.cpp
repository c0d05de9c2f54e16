#include "hal/rmp/codec.h"

namespace cgsr::hal::rmp {
namespace {

constexpr std::uint8_t kSize = 8;

std::uint16_t slot(const CanFrame& frame, std::size_t n) {
  return static_cast<std::uint16_t>(frame.data[2 * n] << 8 | frame.data[2 * n + 1]);
}

std::int16_t signed_slot(const CanFrame& frame, std::size_t n) {
  return static_cast<std::int16_t>(slot(frame, n));
}

std::uint32_t double_slot(const CanFrame& frame, std::size_t n) {
  return slot(frame, n) | static_cast<std::uint32_t>(slot(frame, n + 1)) << 16;
}

void put(CanFrame& frame, std::size_t n, std::uint16_t value) {
  frame.data[2 * n] = static_cast<std::uint8_t>(value >> 8);
  frame.data[2 * n + 1] = static_cast<std::uint8_t>(value);
}

}  // namespace

std::string_view to_string(DecodeFailure failure) {
  switch (failure) {
    case DecodeFailure::kUnknownId:
      return "unknown id";
    case DecodeFailure::kWrongSize:
      return "wrong size";
  }
  return "";
}

tl::expected<Message, DecodeFailure> decode(const CanFrame& f) {
  const auto id = MessageId{f.id};
  if (id == MessageId::kShutdown) return Shutdown{};
  if (id == MessageId::kUnexplained || id == MessageId::kUserInterface) return Ignored{};
  const auto eight = [&f](const auto& message) -> tl::expected<Message, DecodeFailure> {
    if (f.size != kSize) return tl::unexpected(DecodeFailure::kWrongSize);
    return message;
  };
  switch (id) {
    case MessageId::kBuild:
      return eight(Build{slot(f, 0)});
    case MessageId::kAttitude:
      return eight(Attitude{signed_slot(f, 0), signed_slot(f, 1), signed_slot(f, 2), signed_slot(f, 3)});
    case MessageId::kMotion:
      return eight(Motion{signed_slot(f, 0), signed_slot(f, 1), signed_slot(f, 2), slot(f, 3)});
    case MessageId::kWheelDistances:
      return eight(WheelDistances{double_slot(f, 0), double_slot(f, 2)});
    case MessageId::kIntegrated:
      return eight(Integrated{double_slot(f, 0), double_slot(f, 2)});
    case MessageId::kTorques:
      return eight(Torques{signed_slot(f, 0), signed_slot(f, 1)});
    case MessageId::kModeAndPower:
      return eight(ModeAndPower{OperationalMode{slot(f, 0)}, slot(f, 1), slot(f, 2), slot(f, 3)});
    case MessageId::kEcho:
      return eight(Echo{signed_slot(f, 0), signed_slot(f, 1)});
    case MessageId::kStatus:
      return eight(Status{slot(f, 0), slot(f, 1), slot(f, 2)});
    case MessageId::kCommand:
      return eight(Command{signed_slot(f, 0), signed_slot(f, 1), slot(f, 2), slot(f, 3)});
    default:
      return tl::unexpected(DecodeFailure::kUnknownId);
  }
}

CanFrame encode(const Command& command) {
  CanFrame frame{.id = static_cast<std::uint16_t>(MessageId::kCommand), .size = kSize};
  put(frame, 0, static_cast<std::uint16_t>(command.velocity));
  put(frame, 1, static_cast<std::uint16_t>(command.turn));
  put(frame, 2, command.configuration);
  put(frame, 3, command.parameter);
  return frame;
}

}  // namespace cgsr::hal::rmp
