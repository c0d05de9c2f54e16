#pragma once

#include <memory>
#include <utility>

#include "pipeline/motion/motion_loop.h"
#include "tests/motion/scripted_drive.h"

namespace cgsr {

inline bool is_zero(const hal::Twist& twist) {
  return twist.forward_mps == 0.0 && twist.left_radps == 0.0;
}

/// A robot that is a little quicker than the defaults.
inline MotionParameters quick() {
  MotionParameters motion;
  motion.max_forward_mps = motion.max_acceleration_mps2 = 0.4;
  motion.max_deceleration_mps2 = 0.8;
  motion.max_turn_radps = 1.0;
  motion.max_turn_acceleration_radps2 = 2.0;
  return motion;
}

/// A motion loop on a scripted base, stepped at its cycle, with everything well unless a test says otherwise.
template <class DriveType = ScriptedDrive>
struct Rig {
  explicit Rig(const MotionParameters& motion = quick(), MotionLoop::Mode mode = MotionLoop::Mode::kLive)
      : parameters(motion),
        owned(std::make_unique<DriveType>()),
        drive(owned.get()),
        loop(std::move(owned), motion, mode) {
    inputs.images_in_time = true;
    inputs.safety_chain_ok = true;
    EXPECT_TRUE(loop.start());
  }

  /// One cycle later. The goal, if any, belongs to an image of 33 ms ago.
  MotionStatus step(Duration since_last = kMotionPeriod) {
    now += since_last;
    inputs.goal.reset();
    if (goals_come) inputs.goal = Goal{goal, now - seconds(0.033), halt};
    const MotionStatus status = loop.step(now, inputs);
    inputs.request = ArmRequest::kNone;
    return status;
  }

  MotionStatus steps(int count) {
    MotionStatus status;
    for (int i = 0; i < count; ++i) status = step();
    return status;
  }

  MotionStatus request(ArmRequest request) {
    inputs.request = request;
    return step();
  }

  /// Waits until arming is possible, arms, and lets it come up to the goal's speed.
  void arm_and_move(const hal::Twist& twist) {
    goal = {};
    steps(100);
    EXPECT_TRUE(request(ArmRequest::kArm).armed);
    goal = twist;
    steps(300);
  }

  MotionParameters parameters;
  std::unique_ptr<DriveType> owned;
  DriveType* drive;
  MotionLoop loop;
  MonoTime now{seconds(1000.0)};
  MotionInputs inputs;
  hal::Twist goal;
  bool goals_come = true;
  bool halt = false;
};

}  // namespace cgsr
