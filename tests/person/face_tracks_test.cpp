// Faces followed from image to image. They are drawn: the cascade takes them for faces.

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/context.h"
#include "pipeline/person/face/face_tracks.h"
#include "tests/person/drawn_face.h"
#include "tests/support/counted_budget.h"

namespace cgsr::person {
namespace {

cv::Mat people_at(const std::vector<int>& places) {
  cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(120));
  for (const int x : places) draw_face(grey, x, 200, 100.0);
  cv::GaussianBlur(grey, grey, {}, 2.0);
  return grey;
}

ImageView view_of_grey(const cv::Mat& grey) {
  return {grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
}

FaceTracks tracks() {
  return FaceTracks(detector_of_debian());
}

void look(FaceTracks& faces, const cv::Mat& grey, int images, int units) {
  for (int i = 0; i < images; ++i) {
    CountedBudget budget(units);
    faces.look(view_of_grey(grey), budget);
  }
}

std::ptrdiff_t followed_at(const FaceTracks& faces, int x) {
  return std::ranges::count_if(
      faces.tracks(), [&](const FaceTrack& track) { return track.box.x < x && x < track.box.x + track.box.width; });
}

TEST(FaceTracks, ForgetsALostFaceAlsoWhereThereAreMoreThanTheBudgetAllowsFor) {
  constexpr int kUnits = 2;  // as on the robot
  FaceTracks faces = tracks();
  look(faces, people_at({100, 320, 540}), 60, kUnits);
  ASSERT_EQ(faces.tracks().size(), 3U) << "the faces that are drawn are found";
  look(faces, people_at({100, 320}), 15, kUnits);
  EXPECT_EQ(followed_at(faces, 540), 0);
  EXPECT_EQ(faces.tracks().size(), 2U);
}

// A shirt says where the face above it is, but how large only to within a third; of drawn faces the cascade takes more sizes than of real ones.
TEST(FaceTracks, AnExpectedFaceIsFoundSoonAlsoWhereItsSizeIsOff) {
  constexpr int kUnits = 1, kImages = 5;
  const cv::Mat grey = people_at({320});
  FaceTracks patient = tracks();
  look(patient, grey, 60, 2 * kUnits);
  ASSERT_EQ(patient.tracks().size(), 1U) << "the face that is drawn is found";
  const Box face = patient.tracks().front().box;
  const auto found_where = [&](double off_px, double size) {
    FaceTracks faces = tracks();
    const Box expected{face.x + off_px + face.width * (1.0 - size) / 2, face.y + face.height * (1.0 - size) / 2,
                       size * face.width, size * face.height};
    for (int i = 0; i < kImages; ++i) {
      CountedBudget budget(kUnits);
      faces.look(view_of_grey(grey), budget, expected);
    }
    return followed_at(faces, 320) == 1;
  };
  EXPECT_FALSE(found_where(220.0, 1.0)) << "this test could not fail: the search alone is as fast";
  for (const double size : {1.0, 0.5, 2.0}) EXPECT_TRUE(found_where(0.0, size)) << size;
}

// The robot turns from one person to the next: the next one's face comes where the other's was.
TEST(FaceTracks, LeavesAFaceToTheTrackThatFollowedItThere) {
  constexpr int kUnits = 10;
  FaceTracks faces = tracks();
  look(faces, people_at({320}), 40, kUnits);
  ASSERT_EQ(faces.tracks().size(), 1U);
  const std::uint32_t first = faces.tracks()[0].number;
  look(faces, people_at({210, 320}), 40, kUnits);
  ASSERT_EQ(faces.tracks().size(), 2U);
  for (const int x : {238, 266, 294, 320}) look(faces, people_at({x}), 1, kUnits);
  ASSERT_EQ(faces.tracks().size(), 1U);
  EXPECT_NE(faces.tracks()[0].number, first);
}

// Recognition is what costs most: however many faces wait, and however soon they are answered, no second has more comparisons than are allowed.
TEST(FaceTracks, AskForNoMoreComparisonsInASecondThanAreAllowed) {
  constexpr int kSecond = 30, kUnits = 10;
  FaceTrackParameters parameters;
  parameters.ask_again_images = parameters.ask_again_unsure_images = 1;
  parameters.max_comparisons = 4;
  FaceTracks faces(detector_of_debian(), parameters);
  const cv::Mat grey = people_at({210, 320, 430});
  std::vector<int> asked;
  for (int image = 0; image < 5 * kSecond; ++image) {
    look(faces, grey, 1, kUnits);
    const auto question = faces.question(view_of_grey(grey));
    if (!question) continue;
    faces.asked(question->face);
    faces.hear({question->face, {}});
    asked.push_back(image);
  }
  ASSERT_GE(asked.size(), 16U) << "of 20";
  EXPECT_LE(asked[3] - asked[0], 5) << "the first are not spread: a name is told at once";
  for (std::size_t i = 4; i < asked.size(); ++i) EXPECT_GE(asked[i] - asked[i - 4], kSecond);
}

// How far the face stands out of the noise goes with the question; how bright it is does not matter.
// What may be no face at all says nothing of whose it is: neither takes it a vote's place nor makes it what is known less sure.
TEST(FaceTracks, AnAnswerThatDoesNotCountChangesNothing) {
  FaceTracks faces = tracks();
  look(faces, people_at({320}), 60, 2);
  ASSERT_EQ(faces.tracks().size(), 1U);
  FaceAnswer stranger, no_face;
  stranger.face = no_face.face = faces.tracks().front().number;
  stranger.match.confidence = no_face.match.confidence = 0.9;
  stranger.match.nearest = 1;
  stranger.match.rules_out = 0.8;
  no_face.match.nearest = 2;
  no_face.counts = false;
  faces.hear(stranger);
  for (int i = 0; i < 5; ++i) faces.hear(no_face);
  EXPECT_FALSE(faces.tracks().front().match);
  faces.hear(stranger);
  ASSERT_TRUE(faces.tracks().front().match);
  const FaceMatch known = *faces.tracks().front().match;
  for (int i = 0; i < 5; ++i) faces.hear(no_face);
  EXPECT_EQ(faces.tracks().front().match->confidence, known.confidence);
  EXPECT_EQ(faces.tracks().front().match->rules_out, known.rules_out);
  EXPECT_GT(known.rules_out, 0.5);
}

TEST(FaceTracks, TellHowFarAFaceStandsOutOfTheNoise) {
  const auto ratio_in = [](double noise) {
    cv::Mat grey = people_at({320}), noisy(480, 640, CV_8UC1), yuyv(480, 640, CV_8UC2, cv::Scalar(0, 128));
    cv::RNG random(5);
    cv::Mat deviation(480, 640, CV_32F), sum;
    random.fill(deviation, cv::RNG::NORMAL, 0.0, noise);
    grey.convertTo(sum, CV_32F, 0.25, 60.0);
    cv::Mat(sum + deviation).convertTo(noisy, CV_8U);
    cv::insertChannel(noisy, yuyv, 0);
    FaceTracks faces = tracks();
    const ImageView image{yuyv.data, 640, 480, static_cast<std::ptrdiff_t>(yuyv.step), PixelFormat::kYuyv};
    for (int i = 0; i < 60; ++i) {
      CountedBudget budget(2);
      faces.look(image, budget);
    }
    const auto question = faces.question(image);
    return question ? question->signal_to_noise : -1.0;
  };
  const double clear = ratio_in(0.5), noisy = ratio_in(4.0);
  EXPECT_GT(clear, 3.5);
  EXPECT_LT(clear, kNoNoise);
  EXPECT_GT(noisy, 0.0);
  EXPECT_LT(noisy, 0.5 * clear);
}

}  // namespace
}  // namespace cgsr::person
