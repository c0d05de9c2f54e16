#pragma once

#include "pipeline/person/face/face_recognizer.h"
#include "src/tasks/links.h"

namespace cgsr::tasks {

/// Names faces, and learns new views of them, on a thread of its own, below everything that has a deadline.
class RecognitionTask {
 public:
  RecognitionTask(person::FaceTrainer trainer, Links& links) : trainer_(std::move(trainer)), links_(links) {}

  /// Answers every question that is there.
  void step();

 private:
  person::FaceTrainer trainer_;
  Links& links_;
};

/// The vision thread's end of it.
class LinkedRecognizer final : public person::FaceRecognizer {
 public:
  explicit LinkedRecognizer(Links& links) : links_(links) {}

  bool ask(person::FaceQuestion&& question) override;
  std::optional<person::FaceAnswer> answer() override { return links_.face_answers.pop(); }

 private:
  Links& links_;
};

}  // namespace cgsr::tasks
