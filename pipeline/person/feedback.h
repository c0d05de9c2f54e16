#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/person/classifier.h"

namespace cgsr::person {

/// What one classifier did in one step of the feedback.
struct FeedbackMember {
  int level = 0;                                        ///< 0: primary, 1: secondary, and so on.
  bool required = true;                                 ///< in: whether it runs (IsPriCharRequired of Alg. 6.1).
  double reliability = 1.0;                             ///< in: by how much its confidence counts now, in [0, 1].
  std::optional<Classification> answer = std::nullopt;  ///< what it answered, its confidence already scaled.
  bool trained = false;                                 ///< whether it was trained with the class that was decided on.
};

/// Settles what classifiers of several levels answered: Alg. 6.1, lines 10 to 29, for any number of levels and of classifiers in each.
///
/// The class of the uppermost classifier that answered stands until one further down contradicts it with at least the same confidence; the order is
/// that of `members`, which is by level. Then, of the classifiers that ran, those are to be trained that named another class (lines 16 and 19), and those
/// that found nothing although a higher level decided (line 23). A classifier that found nothing is not trained by a lower level: what it would
/// be trained with is not there.
///
/// With one primary and one secondary this is Alg. 6.1 to the letter.
///
/// \param members  ordered by level, the primary first; `trained` is set.
/// \return the class with the confidence of who decided it, or nothing when nobody answered.
std::optional<Classification> settle(std::span<FeedbackMember> members);

/// Classifiers that teach each other (Alg. 6.1). It knows no faces: whoever can classify an Input and be trained may take part.
///
/// Threads: one. Allocates when classifiers are added only.
template <class Input>
class FeedbackClassifier {
 public:
  /// \param classifier  outlives this.  \param level  not below that of the one added before.  \return its place among members().
  std::size_t add(Classifier<Input>& classifier, int level) {
    classifiers_.push_back(&classifier);
    members_.push_back({.level = level});
    return members_.size() - 1;
  }

  /// Whether a classifier is to run in the next step, and how much its confidence counts then. Both stay until they are set again.
  void require(std::size_t place, bool required) { members_[place].required = required; }
  void rely(std::size_t place, double reliability) { members_[place].reliability = reliability; }

  /// One step: everyone who is required classifies, the answers are settled, whoever was wrong or blind is trained.
  std::optional<Classification> classify(const Input& input) {
    for (std::size_t i = 0; i < members_.size(); ++i) {
      FeedbackMember& member = members_[i];
      member.answer = member.required ? classifiers_[i]->classify(input) : std::nullopt;
      if (member.answer) member.answer->confidence *= member.reliability;
    }
    const auto settled = settle(members_);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      if (!members_[i].trained) continue;
      const auto& answer = members_[i].answer;
      classifiers_[i]->train(settled->label, answer ? std::optional(answer->label) : std::nullopt);
    }
    return settled;
  }

  /// What everyone did in the last step.
  [[nodiscard]] std::span<const FeedbackMember> members() const { return members_; }

 private:
  std::vector<Classifier<Input>*> classifiers_;
  std::vector<FeedbackMember> members_;
};

}  // namespace cgsr::person
