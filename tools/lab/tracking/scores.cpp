#include "tools/lab/tracking/scores.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace cgsr::lab {
namespace {

constexpr double kRounding = 1e-9;  // identical boxes may have an IoU of a little less than 1

double centre_distance(const Box& a, const Box& b) {
  return std::hypot(a.x + a.width / 2 - b.x - b.width / 2, a.y + a.height / 2 - b.y - b.height / 2);
}

void add_to_curves(double iou, double distance_px, RunScore& score) {
  for (int t = 0; t < kSuccessThresholds; ++t) {
    const double threshold = static_cast<double>(t) / (kSuccessThresholds - 1);
    score.success[static_cast<std::size_t>(t)] += t == 0 ? iou > 0.0 : iou >= threshold - kRounding;
  }
  for (int t = 0; t < kPrecisionThresholds; ++t) score.precision[static_cast<std::size_t>(t)] += distance_px <= t;
}

/// Follows one run from on the object to lost and back.
class LossBook {
 public:
  explicit LossBook(RunScore& score) : score_(score) {}

  void visible(int image, double iou) {
    if (!is_lost_ && iou < kOffIou) {
      score_.losses.push_back(image);
      is_lost_ = true;
    } else if (is_lost_ && iou >= kAgainIou) {
      score_.recoveries.push_back(image - score_.losses.back());
      is_lost_ = false;
    }
  }

 private:
  RunScore& score_;
  bool is_lost_ = false;
};

template <std::size_t N>
void add_to(std::array<double, N>& sum, const std::array<double, N>& values, double weight) {
  for (std::size_t i = 0; i < N; ++i) sum[i] += weight * values[i];
}

void finish(RunScore& score) {
  score.auc = std::accumulate(score.success.begin(), score.success.end(), 0.0) / kSuccessThresholds;
  score.precision_20px = score.precision[static_cast<std::size_t>(kPrecisionAt_px)];
}

}  // namespace

RunScore score_run(const Boxes& track, const Boxes& truth) {
  RunScore score;
  score.boxes = lab::score(track, truth);
  LossBook book(score);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const auto& box = i < track.size() ? track[i] : std::nullopt;
    score.claims += box.has_value();
    if (!truth[i]) {
      ++score.images_without_object;
      score.claims_without_object += box.has_value();
      score.false_claims += box.has_value();
      continue;
    }
    const double iou = score_image(*truth[i], box).iou;
    score.false_claims += box && iou < kOffIou;
    add_to_curves(iou, box ? centre_distance(*truth[i], *box) : std::numeric_limits<double>::infinity(), score);
    book.visible(static_cast<int>(i), iou);
  }
  const double images = std::max(score.boxes.images, 1);
  for (double& share : score.success) share /= images;
  for (double& share : score.precision) share /= images;
  finish(score);
  return score;
}

RunScore mean_score(std::span<const RunScore> runs) {
  RunScore mean;
  const double weight = runs.empty() ? 0.0 : 1.0 / static_cast<double>(runs.size());
  for (const RunScore& run : runs) {
    add_to(mean.success, run.success, weight);
    add_to(mean.precision, run.precision, weight);
    mean.boxes.precision += weight * run.boxes.precision;
    mean.boxes.recall += weight * run.boxes.recall;
    mean.boxes.iou += weight * run.boxes.iou;
    mean.boxes.success += weight * run.boxes.success;
    mean.boxes.found += weight * run.boxes.found;
    mean.boxes.images += run.boxes.images;
    mean.losses.insert(mean.losses.end(), run.losses.begin(), run.losses.end());
    mean.recoveries.insert(mean.recoveries.end(), run.recoveries.begin(), run.recoveries.end());
    mean.claims += run.claims;
    mean.false_claims += run.false_claims;
    mean.images_without_object += run.images_without_object;
    mean.claims_without_object += run.claims_without_object;
  }
  finish(mean);
  return mean;
}

}  // namespace cgsr::lab
