#include "pipeline/person/feedback.h"

namespace cgsr::person {

std::optional<Classification> settle(std::span<FeedbackMember> members) {
  const FeedbackMember* decided = nullptr;
  for (const FeedbackMember& member : members) {
    if (!member.answer) continue;
    const bool contradicts = decided != nullptr && member.answer->label != decided->answer->label;
    if (decided == nullptr || (contradicts && member.answer->confidence >= decided->answer->confidence))
      decided = &member;
  }
  for (FeedbackMember& member : members) {
    const bool mistaken = decided != nullptr && member.answer && member.answer->label != decided->answer->label;
    const bool blind = decided != nullptr && member.required && !member.answer && decided->level < member.level;
    member.trained = mistaken || blind;
  }
  if (decided == nullptr) return std::nullopt;
  return decided->answer;
}

}  // namespace cgsr::person
