#pragma once

#include <atomic>
#include <cstdint>

#include "hal/camera.h"
#include "pipeline/motion/motion_loop.h"
#include "pipeline/person/face/face_recognizer.h"
#include "pipeline/runtime/motion_stop.h"
#include "pipeline/stages/switchboard.h"
#include "platform/image_lease.h"
#include "platform/ring.h"
#include "platform/time.h"
#include "platform/wake_up.h"
#include "src/sinks/records.h"

namespace cgsr::tasks {

/// How many images capture could not get, by reason; read by anybody.
struct CaptureCounts {
  std::atomic<std::uint64_t> images{0};
  std::atomic<std::uint64_t> timeouts{0};
  std::atomic<std::uint64_t> no_slot{0};
  std::atomic<std::uint64_t> corrupt{0};
  std::atomic<std::uint64_t> disconnected{0};
};

/// A report of the arming line that is older than this counts as a switch that is off: ten looks of the switch worker.
/// Ours.
inline constexpr Duration kMaxArmingReportAge = seconds(0.5);

/// When the switch worker last read the arming line, whatever the line answered. A worker that hangs in a driver must not
/// leave the line's last state in force. Without a first report there is no arming line, and none is ever old.
///
/// Threads: report() from the switch worker, the first before any thread starts; is_old() from the motion thread too.
/// report() releases and is_old() acquires: a motion cycle to which a report is new sees the request to disarm that was pushed
/// before it. Ours.
class ArmingReport {
 public:
  void report(MonoTime now) { at_.store(now, std::memory_order_release); }

  [[nodiscard]] bool is_old(MonoTime now) const {
    return now - kMaxArmingReportAge > at_.load(std::memory_order_acquire);
  }

 private:
  std::atomic<MonoTime> at_{MonoTime::max()};
};

/// Everything that tasks share: the arrows of docs/architecture.md, one member each. Every ring has one producer and one consumer.
struct Links {
  Ring<ImageLease, 4> images;  ///< capture -> vision, which takes the newest.
  WakeUp image_came;
  std::atomic<bool> images_ended{false};  ///< the recording is over.
  std::atomic<bool> camera_lost{false};   ///< the device is gone; also when it was told to stop.
  CaptureCounts capture;

  Ring<Goal, 8> goals;  ///< vision -> motion.
  std::atomic<bool> images_in_time{false};
  runtime::MotionStop motion_stop;  ///< stages of the safety chain -> motion.

  Ring<hal::Odometry, 64, Overflow::kDiscard> odometry;  ///< motion -> vision.

  Ring<ArmRequest, 8> arm_requests;  ///< switch worker -> motion.
  ArmingReport arming_report;        ///< switch worker -> motion.

  Ring<stages::SwitchRequest, 8> switch_requests;                ///< vision -> switch worker.
  Ring<stages::SwitchAnswer, 8> switch_answers;                  ///< switch worker -> vision.
  Ring<sinks::SwitchRecord, 64, Overflow::kDiscard> switchings;  ///< switch worker -> housekeeping.

  Ring<person::FaceQuestion, 1> face_questions;  ///< vision -> recognition.
  WakeUp face_question_came;
  Ring<person::FaceAnswer, 1> face_answers;  ///< recognition -> vision.

  Ring<sinks::VisionReport, 64, Overflow::kDiscard> reports;  ///< vision -> housekeeping.
  Ring<sinks::Picture, 2, Overflow::kDiscard>
      pictures;  ///< vision -> housekeeping: at most two images are held downstream.
  Ring<MotionStatus, 512, Overflow::kDiscard> motions;  ///< motion -> housekeeping.
};

}  // namespace cgsr::tasks
