#include "pipeline/stages/search_people_task.h"

#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/person/tracking/person_tracker.h"
#include "tests/behavior/two_rooms.h"

namespace cgsr::stages {
namespace {

constexpr Duration kImage = seconds(1.0 / 30.0);
constexpr double kFace_m = 0.16, kFocal_px = 600.0, kCamera_m = 1.4;

/// A robot at (2, 1) that looks along y and sees one face.
class SearchPeople : public testing::Test {
 protected:
  SearchPeople() {
    camera_.fx_px = camera_.fy_px = kFocal_px;
    camera_.cx_px = 320.0;
    camera_.cy_px = 240.0;
    parameters_.face_width_m = kFace_m;
    parameters_.images_to_name = 5;
    parameters_.max_duration_s = 10.0;
    behavior::SearchPeople search(parameters_, behavior::FreeFloor(behavior::test::two_rooms(), {}),
                                  {{2.0, 1.0}, {6.0, 1.0}}, behavior::DriveLimits{});
    task_.emplace(std::move(search), parameters_, camera_);
    frame_.pose.age = frame_.people.age = Duration::zero();
    PoseEstimate& pose = frame_.pose.value;
    pose.has_map = true;
    pose.robot = {true, 2.0, 1.0, std::numbers::pi / 2};
    pose.camera.X_WC.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // x right is x, y down is -z, z forward is y
    pose.camera.X_WC.translation() << 2.0, 1.0, kCamera_m;
  }

  /// \param away_m  before the camera.  \param right_m  to the right, and `up_m` above it.
  void see_face(double away_m, double right_m, double up_m, std::optional<person::Label> person) {
    const double width_px = kFace_m * kFocal_px / away_m;
    person::SeenFace face;
    face.box = {camera_.cx_px + kFocal_px * right_m / away_m - width_px / 2,
                camera_.cy_px - kFocal_px * up_m / away_m - width_px / 2, width_px, width_px};
    face.compared = true;
    face.person = person;
    face.confidence = 0.8;
    frame_.people.value.faces[0] = face;
    frame_.people.value.face_count = 1;
  }

  std::vector<Event> run(double longest_s) {
    std::vector<Event> said;
    for (double time_s = 0.0; time_s < longest_s; time_s += to_seconds(kImage)) {
      last_ = task_->decide(frame_, image_, kImage);
      for (const Event& event : last_.events) said.push_back(event);
    }
    return said;
  }

  geometry::Camera camera_;
  behavior::SearchPeopleParameters parameters_;
  std::optional<SearchPeopleTask> task_;
  FrameResult frame_;
  Decision last_;
  ImageView image_{nullptr, 640, 480, 1280, PixelFormat::kYuyv};
};

TEST_F(SearchPeople, SaysWhereInTheMapSomebodyStandsByBearingAndWidthOfTheFace) {
  see_face(2.0, 0.5, 0.2, 3);
  const auto said = run(2.0);
  ASSERT_EQ(said.size(), 1U) << "once for each person";
  EXPECT_EQ(said[0].source, "says");
  EXPECT_EQ(said[0].state, "here is");
  ASSERT_EQ(said[0].number_count, 4U);
  EXPECT_EQ(said[0].numbers[0].name, "number");
  EXPECT_EQ(said[0].numbers[0].value, 3.0);
  EXPECT_NEAR(said[0].numbers[1].value, 0.8, 1e-9);
  EXPECT_NEAR(said[0].numbers[2].value, 2.5, 0.01);
  EXPECT_NEAR(said[0].numbers[3].value, 3.0, 0.01);
}

TEST_F(SearchPeople, TellsOfAllInTheEndAndOfAStrangerWithoutANumber) {
  see_face(2.0, 0.0, 0.2, std::nullopt);
  const auto said = run(11.0);
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(said[0].state, "here is somebody whom I do not know");
  EXPECT_EQ(said[1].state, "there stands somebody whom I do not know");
  EXPECT_EQ(said[1].numbers[0].name, "confidence");
  EXPECT_EQ(last_.state, "has told where who is");
}

// From afar a known person may look like a stranger; what is seen from near counts by the area of the face.
TEST_F(SearchPeople, BelievesWhatItSeesFromNearMoreThanWhatItSawFromAfar) {
  see_face(2.4, 0.0, 0.2, std::nullopt);
  run(2.0);
  see_face(1.2, 0.0, 0.2, 3);
  frame_.pose.value.camera.X_WC.translation().y() += 1.2;  // the same place
  run(1.0);
  frame_.people.value.face_count = 0;
  const auto said = run(9.0);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back().state, "there stands");
  EXPECT_EQ(said.back().numbers[0].value, 3.0);
}

TEST_F(SearchPeople, StandsBeforeAFaceUntilItIsNamed) {
  see_face(2.0, 0.0, 0.2, 3);
  frame_.people.value.faces[0].compared = false;
  EXPECT_TRUE(run(1.0).empty());
  EXPECT_EQ(last_.goal.left_radps, 0.0);
  EXPECT_EQ(last_.state, "looking at somebody");
}

// Three metres away a face has 32 px; on the floor and under the ceiling there are none.
TEST_F(SearchPeople, DoesNotTakeForAPersonWhatIsTooFarTooLowOrTooHigh) {
  for (const auto& [away_m, up_m] : {std::pair{3.0, 0.2}, {2.0, -0.9}, {2.0, 0.8}}) {
    see_face(away_m, 0.0, up_m, 3);
    EXPECT_TRUE(run(1.0).empty()) << away_m << ", " << up_m;
  }
}

TEST_F(SearchPeople, HaltsAndNoticesNobodyWithoutAPose) {
  see_face(2.0, 0.0, 0.2, 3);
  frame_.pose.value.robot.known = false;
  EXPECT_TRUE(run(2.0).empty());
  EXPECT_TRUE(last_.halt);
}

}  // namespace
}  // namespace cgsr::stages
