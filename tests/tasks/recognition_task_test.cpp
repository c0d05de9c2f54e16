#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "platform/clock.h"
#include "src/tasks/recognition_task.h"

namespace cgsr::tasks {
namespace {

TEST(RecognitionTask, AnswersTheQuestionThatItWasWokenForAndNoSecondOne) {
  Links links;
  LinkedRecognizer recognizer(links);
  RecognitionTask task(person::FaceTrainer(person::FaceGallery{}), links);
  EXPECT_FALSE(recognizer.answer());
  EXPECT_TRUE(recognizer.ask({7, {}}));
  EXPECT_FALSE(recognizer.ask({8, {}})) << "one question at a time";
  task.step();
  const auto answer = recognizer.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->face, 7U);
  EXPECT_FALSE(answer->match.label) << "nobody is enrolled";
  EXPECT_FALSE(recognizer.answer());
}

/// People whose faces are noise: to be compared with all of them takes longer than an image.
person::FaceGallery crowd(person::Label people) {
  person::FaceGallery gallery;
  std::mt19937 random(1);
  for (person::Label person = 1; person <= people; ++person) {
    for (int view = 0; view < 2; ++view) {
      person::FaceView noise{};
      for (auto& value : noise) value = static_cast<std::uint8_t>(random() % 64);
      gallery.enroll(person, noise);
    }
  }
  return gallery;
}

// The frame path asks, hears nothing and goes on: no image is late because a face takes long.
TEST(RecognitionTask, HoldsNobodyUpWhileItComparesAndLearns) {
  constexpr int kSide = 180;
  constexpr std::size_t kPasses = 2;  // of the frame path at least, while one face is named
  Links links;
  LinkedRecognizer recognizer(links);
  RecognitionTask task(person::FaceTrainer(crowd(600)), links);
  person::GreyPatch crop{kSide, kSide, std::vector<std::uint8_t>(std::size_t{kSide} * kSide)};
  for (std::size_t i = 0; i < crop.pixels.size(); ++i) crop.pixels[i] = static_cast<std::uint8_t>(i * i % 251);
  ASSERT_TRUE(recognizer.ask({1, crop}));
  std::thread thread([&] { task.step(); });
  const RealClock clock;
  std::vector<double> held_s;
  std::optional<person::FaceAnswer> answer;
  while (!answer && held_s.size() < 20'000) {
    const MonoTime before = clock.now();
    answer = recognizer.answer();
    held_s.push_back(to_seconds(clock.now() - before));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  thread.join();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->face, 1U);
  EXPECT_GT(held_s.size(), kPasses) << "it answered at once: the gallery is too small to show anything";
  std::ranges::nth_element(held_s, held_s.begin() + static_cast<std::ptrdiff_t>(held_s.size() / 2));
  EXPECT_LT(held_s[held_s.size() / 2], 1e-3);
}

TEST(RecognitionTask, HandsOverBetweenTwoThreads) {
  constexpr std::uint32_t kQuestions = 200;
  Links links;
  LinkedRecognizer recognizer(links);
  RecognitionTask task(person::FaceTrainer(person::FaceGallery{}), links);
  const RealClock clock;
  std::atomic<bool> ends{false};
  std::thread thread([&] {
    while (!ends) {
      static_cast<void>(links.face_question_came.wait_until(clock.now() + seconds(0.01)));
      task.step();
    }
  });
  for (std::uint32_t face = 0; face < kQuestions; ++face) {
    EXPECT_TRUE(recognizer.ask({face, {}}));
    std::optional<person::FaceAnswer> answer;
    while (!answer) answer = recognizer.answer();
    EXPECT_EQ(answer->face, face);
  }
  ends = true;
  thread.join();
}

}  // namespace
}  // namespace cgsr::tasks
