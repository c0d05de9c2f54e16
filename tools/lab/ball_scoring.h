#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "tools/lab/ball_film.h"
#include "tools/lab/scoring.h"

namespace cgsr::lab {

/// How boxes meet the orange ball's in the images in which it can be seen, and what is said in the others.
struct BallScore {
  int images = 0;        ///< with the orange ball in view.
  double overlap = 0.0;  ///< sums over them: |A and B| / |A|, the dissertation's figure; 0 where nothing was found.
  double precision = 0.0;
  double iou = 0.0;
  int found = 0;
  int elsewhere = 0;  ///< found, but not on the ball.

  int absent = 0;           ///< images without it.
  int found_in_absent = 0;  ///< and something was taken for it.
  int brown = 0;            ///< images with the brown ball in view.
  int brown_tracked = 0;    ///< and it was taken for the orange one.

  int right = 0;  ///< images answered as they are: IoU above 0.5, or nothing said where there is nothing.

  [[nodiscard]] double right_share() const { return static_cast<double>(right) / std::max(1, images + absent); }
  [[nodiscard]] double mean(double sum) const { return images > 0 ? sum / images : 0.0; }
  /// Images in which something else was taken for the ball, as a share of all.
  [[nodiscard]] double false_share() const {
    return static_cast<double>(elsewhere + found_in_absent) / std::max(1, images + absent);
  }

  void add(const std::optional<Box>& orange, const std::optional<Box>& brown_box, const std::optional<Box>& said) {
    if (brown_box) {
      ++brown;
      if (said && !intersection(*brown_box, *said).empty()) ++brown_tracked;
    }
    if (!orange) {
      ++absent;
      ++(said ? found_in_absent : right);
      return;
    }
    ++images;
    const ImageScore one = score_image(*orange, said);
    overlap += one.recall;
    precision += one.precision;
    iou += one.iou;
    if (one.found) ++found;
    if (one.success) ++right;
    if (one.found && one.iou <= 0.0) ++elsewhere;
  }

  void add(const BallScore& other) {
    images += other.images;
    overlap += other.overlap;
    precision += other.precision;
    iou += other.iou;
    found += other.found;
    elsewhere += other.elsewhere;
    absent += other.absent;
    found_in_absent += other.found_in_absent;
    right += other.right;
    brown += other.brown;
    brown_tracked += other.brown_tracked;
  }
};

/// The same by scene.
struct BallScores {
  std::array<BallScore, kBallScenes> of_scene;

  [[nodiscard]] BallScore all() const {
    BallScore sum;
    for (const BallScore& one : of_scene) sum.add(one);
    return sum;
  }
};

}  // namespace cgsr::lab
