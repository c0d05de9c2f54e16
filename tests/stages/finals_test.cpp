// What the robot of the Finals says (6.4.3).

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/stages/finals_task.h"

namespace cgsr::stages {
namespace {

constexpr Duration kImage = seconds(1.0 / 30.0);
constexpr int kWidth_px = 640, kHeight_px = 480;

/// A YUYV image of one colour.
std::vector<std::uint8_t> plain(std::uint8_t y, std::uint8_t u, std::uint8_t v) {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < kWidth_px * kHeight_px / 2; ++i) bytes.insert(bytes.end(), {y, u, y, v});
  return bytes;
}

class Finals : public testing::Test {
 protected:
  Finals() : task_({}, person(), {}, {}, camera()) {}

  static behavior::FollowPersonParameters person() {
    behavior::FollowPersonParameters parameters;
    parameters.number = 1;
    return parameters;
  }
  static geometry::Camera camera() {
    geometry::Camera camera;
    camera.width_px = kWidth_px, camera.height_px = kHeight_px;
    camera.fx_px = camera.fy_px = 600.0;
    camera.cx_px = 320.0, camera.cy_px = 240.0;
    return camera;
  }

  /// So many images in which somebody is identified by this; \return what was said.
  std::vector<std::string> see(person::Label who, person::PersonSource by, const std::vector<std::uint8_t>& shirt,
                               int images = 20, int age_images = 0) {
    FrameResult frame;
    auto& sighting = frame.people.value.person;
    sighting.person = who;
    sighting.source = by;
    sighting.box = {270, 60, 100, 100};
    sighting.face_px = 100;
    sighting.age_images = age_images;
    frame.people.age = Duration::zero();
    const ImageView image{shirt.data(), kWidth_px, kHeight_px, std::ptrdiff_t{2} * kWidth_px, PixelFormat::kYuyv};
    std::vector<std::string> said;
    for (int i = 0; i < images; ++i) {
      last_ = task_.decide(frame, image, kImage);
      for (const Event& event : last_.events)
        if (event.source == "says") said.emplace_back(event.state);
    }
    return said;
  }

  using Words = std::vector<std::string>;
  static constexpr auto kFace = person::PersonSource::kFace;
  static constexpr auto kShirt = person::PersonSource::kShirt;
  const std::vector<std::uint8_t> green_ = plain(120, 90, 90), green_bright_ = plain(170, 78, 78),
                                  red_ = plain(120, 110, 200);
  FinalsTask task_;
  Decision last_;
};

TEST_F(Finals, TellsThatItKnowsThePersonOnce) {
  EXPECT_EQ(see(1, kFace, green_), Words{"I know you, and follow you"});
  EXPECT_EQ(see(1, kShirt, green_), Words{});
  EXPECT_EQ(see(1, kFace, green_), Words{});
  EXPECT_EQ(task_.state(), FinalsState::kWith);
}

TEST_F(Finals, AShirtAloneTellsNothingOfWhoWearsIt) {
  EXPECT_EQ(see(1, kShirt, green_, 100), Words{});
  EXPECT_EQ(task_.state(), FinalsState::kMeeting);
}

TEST_F(Finals, TellsAStrangerOnceThatItHasLostThePerson) {
  see(1, kFace, green_);
  see(1, kShirt, green_);
  EXPECT_EQ(see(person::kStranger, kFace, green_),
            Words{"you are somebody else: I have lost the person whom I follow"});
  EXPECT_EQ(task_.state(), FinalsState::kSeeking);
  EXPECT_EQ(see(person::kStranger, kFace, green_, 100), Words{});
}

TEST_F(Finals, AStrangersShirtCountsWhereHisFaceIsLost) {
  see(1, kFace, green_);
  EXPECT_EQ(see(person::kStranger, kFace, green_, 1), Words{});
  EXPECT_EQ(see(person::kStranger, kShirt, green_), Words{}) << "one image of a face decides nothing";
  EXPECT_EQ(see(person::kStranger, kFace, green_, 1), Words{});
  EXPECT_EQ(see(person::kStranger, kShirt, green_),
            Words{"you are somebody else: I have lost the person whom I follow"});
}

TEST_F(Finals, OneImageOfAStrangerIsNoStranger) {
  see(1, kFace, green_);
  EXPECT_EQ(see(person::kStranger, kFace, green_, 1), Words{});
  EXPECT_EQ(see(1, kFace, green_), Words{});
}

// Between two looks for a face it is told once more who the last one named.
TEST_F(Finals, AFaceThatIsNotLookedForDecidesNothingAnew) {
  see(1, kFace, green_);
  EXPECT_EQ(see(person::kStranger, kFace, green_, 1), Words{});
  EXPECT_EQ(see(person::kStranger, kFace, green_, 20, 1), Words{});
  EXPECT_NE(see(person::kStranger, kFace, green_, 20), Words{});
}

TEST_F(Finals, BeforeThePersonIsKnownAStrangerIsNoLoss) {
  EXPECT_EQ(see(person::kStranger, kFace, green_), Words{});
  EXPECT_EQ(see(1, kFace, green_), Words{"I know you, and follow you"});
}

TEST_F(Finals, TellsThatTheShirtIsAnotherOne) {
  see(1, kFace, green_);
  see(person::kStranger, kFace, green_);
  EXPECT_EQ(see(1, kFace, red_), (Words{"I have found you again", "you wear another shirt"}));
  // And back: what is compared with is the shirt that was seen last.
  see(person::kStranger, kFace, red_);
  EXPECT_EQ(see(1, kFace, green_), (Words{"I have found you again", "you wear another shirt"}));
}

TEST_F(Finals, TellsThatTheShirtIsTheSameInABrighterLight) {
  see(1, kFace, green_);
  see(person::kStranger, kFace, green_);
  EXPECT_EQ(see(1, kFace, green_bright_), (Words{"I have found you again", "you wear the same shirt"}));
}

TEST_F(Finals, SaysNothingOfAShirtThatItHasHardlySeen) {
  see(1, kFace, green_, 4);
  see(person::kStranger, kFace, green_);
  EXPECT_EQ(see(1, kFace, red_), Words{"I have found you again"});
}

TEST_F(Finals, SomebodyElseWhoIsEnrolledIsNotThePersonEither) {
  see(1, kFace, green_);
  EXPECT_EQ(see(2, kFace, green_), Words{"you are somebody else: I have lost the person whom I follow"});
}

// A stranger who turns his back again is not followed by the shirt.
TEST_F(Finals, LooksForThePersonByTheFaceAlone) {
  see(1, kFace, green_);
  see(1, kShirt, green_);
  EXPECT_FALSE(last_.halt);
  see(person::kStranger, kFace, green_, 5);
  see(1, kShirt, green_, 60);
  EXPECT_TRUE(last_.halt);
  EXPECT_NE(last_.goal.left_radps, 0.0) << "it turns to look for the person";
  EXPECT_EQ(task_.state(), FinalsState::kSeeking);
  see(1, kFace, green_);
  see(1, kShirt, green_);
  EXPECT_FALSE(last_.halt);
}

TEST_F(Finals, TheShirtOfOneWhoWasTakenForThePersonInAnImageIsNotLookedAt) {
  see(1, kFace, green_);
  see(person::kStranger, kFace, green_);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(see(1, kFace, green_, 2), Words{});
    see(person::kStranger, kFace, green_, 1);
  }
  EXPECT_EQ(see(1, kFace, red_), (Words{"I have found you again", "you wear another shirt"}));
}

TEST_F(Finals, FollowsAsThePersonTaskDoes) {
  see(1, kFace, green_);
  FrameResult nobody;
  nobody.people.age = Duration::zero();
  const ImageView image{green_.data(), kWidth_px, kHeight_px, std::ptrdiff_t{2} * kWidth_px, PixelFormat::kYuyv};
  Decision decision;
  for (int i = 0; i < 30; ++i) decision = task_.decide(nobody, image, kImage);
  EXPECT_TRUE(decision.halt);
  EXPECT_EQ(task_.first_requests().person, 1);
}

}  // namespace
}  // namespace cgsr::stages
