#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "pipeline/person/face/face_gallery.h"

namespace cgsr::person {

/// Whose one face is by several comparisons: the newest answer that counts decides with those of the last three that agree with it. Ours: 6.2.1 compares once.
///
/// Others than the nearest are ruled out as surely as by the least sure of those answers, which have to be nearest to the same person.
///
/// A comparison's confidence is 1 - exp(-x) / 2, x its distance from the threshold (FaceGallery::identify). The mean of n comparisons is surer by the root
/// of n. Those of one face are not independent of each other: n is at most 16, and a comparison that contradicts halves it.
class FaceVotes {
 public:
  /// An answer at the threshold says nothing against what is known: whose face is about as far as that would be somebody else's in turns. Nor does it agree with
  /// others that it is a stranger.
  /// \param min_agreeing  of the last three answers, else an older agreement stands.
  void add(const FaceMatch& answer, int min_agreeing);

  /// \return nothing: not known yet. A match without a label: a stranger's.
  [[nodiscard]] const std::optional<FaceMatch>& match() const { return match_; }
  /// Whether the newest answer that counts is another one than match().
  [[nodiscard]] bool contradicted() const;

 private:
  static constexpr std::size_t kVotes = 3;
  std::array<FaceMatch, kVotes> votes_{};  // the newest first
  std::size_t vote_count_ = 0;
  std::optional<FaceMatch> match_;
  int comparisons_ = 0;    // that made match_
  double evidence_ = 0.0;  // their mean x
};

}  // namespace cgsr::person
