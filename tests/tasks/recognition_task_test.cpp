#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

#include <gtest/gtest.h>

#include "platform/clock.h"
#include "src/tasks/recognition_task.h"

namespace cgsr::tasks {
namespace {

TEST(RecognitionTask, AnswersTheQuestionThatItWasWokenForAndNoSecondOne) {
  Links links;
  LinkedRecognizer recognizer(links);
  RecognitionTask task(person::FaceGallery{}, links);
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

TEST(RecognitionTask, HandsOverBetweenTwoThreads) {
  constexpr std::uint32_t kQuestions = 200;
  Links links;
  LinkedRecognizer recognizer(links);
  RecognitionTask task(person::FaceGallery{}, links);
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
