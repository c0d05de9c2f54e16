#include <gtest/gtest.h>

#include "pipeline/motion/motion_loop.h"
#include "tests/motion/rig.h"
#include "tests/support/allocation_guard.h"

namespace cgsr {
namespace {

TEST(MotionLoopAlloc, StepsWithoutAllocatingThroughEveryKindOfFault) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  Rig<LatchingDrive> rig;
  rig.steps(100);
  int armed = 0;
  const test::AllocationGuard guard;
  for (int i = 0; i < 20000; ++i) {
    rig.goal = {0.1 * (i % 7), 0.2 * (i % 5 - 2)};
    rig.inputs.request = i % 3 == 0 ? ArmRequest::kArm : ArmRequest::kNone;
    rig.inputs.images_in_time = i % 50 != 1;
    rig.inputs.safety_chain_ok = i % 1700 != 2;
    rig.inputs.stop = i % 2300 == 3;
    rig.goals_come = i % 100 < 70;
    rig.drive->script.sends = i % 900 != 4;
    rig.drive->script.reports = i % 1100 != 5;
    rig.drive->standing = i % 1300 == 6 ? hal::DriveFault::kEmergencyStop : hal::DriveFault::kNone;
    armed += rig.step().armed ? 1 : 0;
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(armed, 10000);
  EXPECT_LT(armed, 20000);
}

}  // namespace
}  // namespace cgsr
