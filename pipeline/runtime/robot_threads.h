#pragma once

#include <array>
#include <cstddef>

#include "platform/thread.h"

namespace cgsr::runtime {

inline constexpr std::size_t kKiB = 1024;
inline constexpr std::size_t kMiB = 1024 * kKiB;

// The robot's threads, one line each. Why these numbers: docs/threads.md.
inline constexpr ThreadSpec kMotionThread{"motion", SchedulingPolicy::kFifo, 70, 256 * kKiB, 0};
inline constexpr ThreadSpec kCaptureThread{"capture", SchedulingPolicy::kFifo, 60, 512 * kKiB, 4 * kMiB};
inline constexpr ThreadSpec kVisionThread{"vision", SchedulingPolicy::kFifo, 40, 2 * kMiB, 16 * kMiB};
inline constexpr ThreadSpec kSwitchThread{"switches", SchedulingPolicy::kOther, 0, 256 * kKiB, 0};
inline constexpr ThreadSpec kRecognitionThread{"recognition", SchedulingPolicy::kOther, 0, 1 * kMiB, 0};
inline constexpr ThreadSpec kHousekeepingThread{"housekeeping", SchedulingPolicy::kOther, 0, 1 * kMiB, 0};
inline constexpr std::array kRobotThreads{kMotionThread, kCaptureThread,     kVisionThread,
                                          kSwitchThread, kRecognitionThread, kHousekeepingThread};

}  // namespace cgsr::runtime
