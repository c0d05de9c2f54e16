#include "pipeline/person/face/face_votes.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace cgsr::person {
namespace {

constexpr int kMaxComparisons = 16;

double evidence_of(double confidence) {
  constexpr double kMaxConfidence = 0.999;
  return -std::log(2.0 * (1.0 - std::clamp(confidence, 0.5, kMaxConfidence)));
}

}  // namespace

bool FaceVotes::contradicted() const {
  return match_ && vote_count_ > 0 && votes_.front().label != match_->label;
}

void FaceVotes::add(const FaceMatch& answer, int min_agreeing) {
  if (match_ && answer.label != match_->label && answer.confidence < kClearConfidence) {
    if (answer.nearest != match_->nearest) match_->rules_out = 0.0;
    return;
  }
  std::shift_right(votes_.begin(), votes_.end(), 1);
  votes_.front() = answer;
  vote_count_ = std::min(vote_count_ + 1, kVotes);
  int agreeing = 0;
  double evidence = 0.0, rules_out = answer.rules_out;
  for (const FaceMatch& vote : std::span(votes_).first(vote_count_)) {
    if (vote.label != answer.label || (!vote.label && vote.confidence < kClearConfidence)) continue;
    ++agreeing;
    evidence += evidence_of(vote.confidence);
    rules_out = vote.nearest == answer.nearest ? std::min(rules_out, vote.rules_out) : 0.0;
  }
  if (match_ && match_->label == answer.label) {
    comparisons_ = std::min(comparisons_ + 1, kMaxComparisons);
    evidence_ += (evidence_of(answer.confidence) - evidence_) / comparisons_;
  } else if (agreeing >= min_agreeing) {
    comparisons_ = agreeing;
    evidence_ = evidence / agreeing;
  } else {
    comparisons_ = std::max(1, comparisons_ / 2);
    if (match_) {
      match_->confidence = 1.0 - 0.5 * std::exp(-evidence_ * std::sqrt(comparisons_));
      match_->rules_out = 0.0;
    }
    return;
  }
  match_ = answer;
  match_->confidence = 1.0 - 0.5 * std::exp(-evidence_ * std::sqrt(comparisons_));
  match_->rules_out = agreeing >= min_agreeing ? rules_out : 0.0;
}

}  // namespace cgsr::person
