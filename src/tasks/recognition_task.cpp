#include "src/tasks/recognition_task.h"

#include <utility>

namespace cgsr::tasks {

// An answer that finds no room is lost: the ring holds as many as can be asked for at once.
void RecognitionTask::step() {
  while (const auto question = links_.face_questions.pop()) {
    static_cast<void>(links_.face_answers.push(trainer_.answer(*question)));
  }
}

bool LinkedRecognizer::ask(person::FaceQuestion&& question) {
  if (!links_.face_questions.push(std::move(question))) return false;
  links_.face_question_came.wake();
  return true;
}

}  // namespace cgsr::tasks
