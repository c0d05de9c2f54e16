#pragma once

#include <algorithm>
#include <array>

namespace cgsr::behavior {

/// Whose the face of somebody is whom the robot looks at for some images: the name with the most confidence in the sum.
/// Ours: 6.4.1.2 names everybody once.
class NameVotes {
 public:
  /// One image. More than four names for one face: the least likely gives way.
  /// \param number  of the person; 0: a stranger.  \param confidence  of that, 0..1.  \param weight  of this image among the others, > 0.
  void count(int number, double confidence, double weight = 1.0) {
    ++images_;
    weight_ += weight;
    const auto is_it = [number](const Vote& vote) { return vote.images > 0 && vote.number == number; };
    auto vote = std::ranges::find_if(votes_, is_it);
    if (vote == votes_.end()) {
      vote = std::ranges::min_element(votes_, {}, &Vote::confidence);
      *vote = {number, 0, 0.0};
    }
    ++vote->images;
    vote->confidence += weight * confidence;
  }

  /// \return in how many images it was known whose the face is.
  [[nodiscard]] int images() const { return images_; }
  /// \return the most likely number; 0: a stranger, or not known.
  [[nodiscard]] int number() const { return best().number; }
  /// \return the share of the images in which it was that number, weighted by confidence.
  [[nodiscard]] double confidence() const { return weight_ > 0.0 ? best().confidence / weight_ : 0.0; }

 private:
  struct Vote {
    int number = 0;
    int images = 0;
    double confidence = 0.0;  // their sum
  };

  [[nodiscard]] const Vote& best() const { return *std::ranges::max_element(votes_, {}, &Vote::confidence); }

  int images_ = 0;
  double weight_ = 0.0;  // of all images
  std::array<Vote, 4> votes_{};
};

}  // namespace cgsr::behavior
