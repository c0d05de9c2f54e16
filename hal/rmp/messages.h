#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

namespace cgsr::hal::rmp {

// What the Segway RMP 50/100/200/400 says on its CAN bus, in counts as they travel; scales.h gives them units. Positive
// velocities go forward, positive turns and integrated yaw go left; the sign of the yaw *rate* is another matter
// (RmpScales::yaw_rate_sign).

enum class MessageId : std::uint16_t {
  kBuild = 0x400,
  kAttitude = 0x401,
  kMotion = 0x402,
  kWheelDistances = 0x403,
  kIntegrated = 0x404,
  kTorques = 0x405,
  kModeAndPower = 0x406,
  kEcho = 0x407,
  kShutdown = 0x412,
  kCommand = 0x413,
  kUnexplained = 0x414,  ///< seen on the bus, purpose unknown.
  kStatus = 0x680,
  kUserInterface = 0x688,
};
/// \return empty for an id that is none of these: what comes from the bus may be any.
constexpr std::string_view to_string(MessageId id) {
  switch (id) {
    case MessageId::kBuild:
      return "build";
    case MessageId::kAttitude:
      return "attitude";
    case MessageId::kMotion:
      return "motion";
    case MessageId::kWheelDistances:
      return "wheel distances";
    case MessageId::kIntegrated:
      return "integrated";
    case MessageId::kTorques:
      return "torques";
    case MessageId::kModeAndPower:
      return "mode and power";
    case MessageId::kEcho:
      return "echo";
    case MessageId::kShutdown:
      return "shutdown";
    case MessageId::kCommand:
      return "command";
    case MessageId::kUnexplained:
      return "unexplained";
    case MessageId::kStatus:
      return "status";
    case MessageId::kUserInterface:
      return "user interface";
  }
  return "";
}

/// 0x0413, to the base: at most one in 10 ms, at least one in 300 ms. After 400 ms without one it slows to zero.
struct Command {
  std::int16_t velocity = 0;        ///< -1176..1176
  std::int16_t turn = 0;            ///< -1024..1024
  std::uint16_t configuration = 0;  ///< a Configuration; 0 with pure motion.
  std::uint16_t parameter = 0;
  friend bool operator==(const Command&, const Command&) = default;
};
inline constexpr std::int16_t kMostVelocityCounts = 1176;
inline constexpr std::int16_t kMostTurnCounts = 1024;

/// Slot 2 of a command. Only what the driver uses or a person needs to read a log.
enum class Configuration : std::uint16_t {
  kNone = 0,
  kOperationalMode = 16,  ///< parameter: OperationalMode
  kResetIntegrators =
      50,  ///< parameter: 1 right wheel, 2 left wheel, 4 yaw, 8 fore/aft. Does not always take; not used.
};
constexpr std::string_view to_string(Configuration configuration) {
  switch (configuration) {
    case Configuration::kNone:
      return "none";
    case Configuration::kOperationalMode:
      return "operational mode";
    case Configuration::kResetIntegrators:
      return "reset integrators";
  }
  return "";
}

enum class OperationalMode : std::uint16_t { kDisabled = 0, kTractor = 1, kBalance = 2, kPowerDown = 3 };
/// \return empty for a mode that is none of these: what comes from the bus may be any.
constexpr std::string_view to_string(OperationalMode mode) {
  switch (mode) {
    case OperationalMode::kDisabled:
      return "disabled";
    case OperationalMode::kTractor:
      return "tractor";
    case OperationalMode::kBalance:
      return "balance";
    case OperationalMode::kPowerDown:
      return "power down";
  }
  return "";
}

struct Build {
  std::uint16_t build = 0;
  friend bool operator==(const Build&, const Build&) = default;
};

struct Attitude {
  std::int16_t pitch = 0;
  std::int16_t pitch_rate = 0;
  std::int16_t roll = 0;
  std::int16_t roll_rate = 0;
  friend bool operator==(const Attitude&, const Attitude&) = default;
};

struct Motion {
  std::int16_t left = 0;
  std::int16_t right = 0;
  std::int16_t yaw_rate = 0;
  std::uint16_t servo_frame = 0;  ///< counts 10 ms each, wraps after 655.36 s.
  friend bool operator==(const Motion&, const Motion&) = default;
};

/// Displacements start anywhere and wrap at 2^32: only differences mean something.
struct WheelDistances {
  std::uint32_t left = 0;
  std::uint32_t right = 0;
  friend bool operator==(const WheelDistances&, const WheelDistances&) = default;
};

/// As WheelDistances: only differences mean something.
struct Integrated {
  std::uint32_t fore_aft = 0;
  std::uint32_t yaw = 0;
  friend bool operator==(const Integrated&, const Integrated&) = default;
};

struct Torques {
  std::int16_t left = 0;
  std::int16_t right = 0;
  friend bool operator==(const Torques&, const Torques&) = default;
};

struct ModeAndPower {
  OperationalMode mode = OperationalMode::kDisabled;
  std::uint16_t gain_schedule = 0;
  std::uint16_t ui_battery = 0;
  std::uint16_t base_battery = 0;
  friend bool operator==(const ModeAndPower&, const ModeAndPower&) = default;
};

/// The last command that the base took in.
struct Echo {
  std::int16_t velocity = 0;
  std::int16_t turn = 0;
  friend bool operator==(const Echo&, const Echo&) = default;
};

struct Status {
  std::uint16_t controller_mode = 0;
  std::uint16_t word1 = 0;
  std::uint16_t word2 = 0;
  friend bool operator==(const Status&, const Status&) = default;
};

/// Bits of Status::word1. The low byte carries several at once: test bits, never compare bytes.
namespace word1 {
inline constexpr std::uint16_t kSafetyShutdown = 0x0001 | 0x0004;
inline constexpr std::uint16_t kSpeedLimitedToZero = 0x0020;
inline constexpr std::uint16_t kIntegrityFault = 0x0040;
inline constexpr std::uint16_t kMotorsEnabled = 0x0080;
inline constexpr std::uint16_t kBalancing = 0x0100;
inline constexpr std::uint16_t kEmptyBattery = 0x0400;
inline constexpr std::uint16_t kLowBattery = 0x4000;
}  // namespace word1

/// Bits of Status::word2: side A in the low byte, side B in the high byte.
namespace word2 {
inline constexpr std::uint16_t kEmergencyStop = 0x0202;
inline constexpr std::uint16_t kEmptyBattery = 0x1010;
/// Pitch, position error, battery temperature, roll. Not among them: over-speed and low bus voltage, which are
/// warnings.
inline constexpr std::uint16_t kFault = 0x6565;
}  // namespace word2

/// 0x0412. The user interface sends it again and again while the power base is off; a host that sends it takes the
/// power away.
struct Shutdown {
  friend bool operator==(const Shutdown&, const Shutdown&) = default;
};

/// Belongs to the family, carries nothing that is understood well enough to be used.
struct Ignored {
  friend bool operator==(const Ignored&, const Ignored&) = default;
};

using Message = std::variant<Ignored, Build, Attitude, Motion, WheelDistances, Integrated, Torques, ModeAndPower, Echo,
                             Status, Shutdown, Command>;

}  // namespace cgsr::hal::rmp
