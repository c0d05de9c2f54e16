#include "platform/config/documentation.h"

#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/config/robot.h"
#include "src/config/robot_docs.h"
#include "tests/config/audit.h"
#include "tests/config/sample.h"

namespace cgsr::config {
namespace {

TEST(Documentation, HasARowForEveryKey) {
  EXPECT_EQ(markdown<Sample>(), R"(
| key | unit | range | default | meaning |
|---|---|---|---|---|
| `name` |  | text | "home" | What the robot is called \| for people. |
| `armed` |  | true, false | false | Whether it starts armed. |

## `[area]`

Where it may go.

| key | unit | range | default | meaning |
|---|---|---|---|---|
| `from_m` | m | -10..10 | -1 | The left end. |
| `to_m` | m | -10..10 | 1 | The right end. |

## `[stage]`

The schedule.

## `[stage.decode]`

Decoding.

| key | unit | range | default | meaning |
|---|---|---|---|---|
| `every_frames` |  | 1..30 | 1 | Runs in every n-th frame. |
| `budget_us` | µs | 100..33000 | 7000 | The time it may take. |
| `on_overrun` |  | skip, stop_motion | "skip" | What happens when it takes longer. |

## `[stage.track]`

Tracking.

| key | unit | range | default | meaning |
|---|---|---|---|---|
| `every_frames` |  | 1..30 | 1 | Runs in every n-th frame. |
| `budget_us` | µs | 100..33000 | 7000 | The time it may take. |
| `on_overrun` |  | skip, stop_motion | "skip" | What happens when it takes longer. |
)");
}

TEST(DocumentationGolden, PageIsWhatTheParametersSay) {
  std::ifstream file(CGSR_SOURCE_DIR "/docs/config.md");
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_EQ(page.str(), robot_docs()) << "print it again: build/release/cgsr config keys --output docs/config.md";
}

// Names, units, ranges and defaults of every parameter of the robot keep the rules.
TEST(RobotDescription, IsSound) {
  EXPECT_THAT(audit(Robot()), testing::IsEmpty());
}

struct Unsound {
  double speed = 3.0;
  int budget_ms = 3;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("speed", self.speed, {0.0, 1.0}, "m/s", "");
    visit.number("budget_ms", self.budget_ms, {1, 5}, "µs", "Time.");
    visit.number("budget_ms", self.budget_ms, {5, 5}, "", "Time.");
  }
};

TEST(RobotDescription, AuditSeesWhatIsWrong) {
  EXPECT_THAT(
      audit(Unsound()),
      testing::ElementsAre("speed has a default outside its range", "speed does not end in its unit _mps",
                           "speed has no meaning", "budget_ms does not end in its unit _us", "budget_ms has no range",
                           "budget_ms has a default outside its range", "budget_ms is described twice"));
}

}  // namespace
}  // namespace cgsr::config
