#include "tools/lab/tracking/measure.h"

#include <algorithm>
#include <cmath>

#include "tools/lab/tracking/robustness.h"

namespace cgsr::lab {
namespace {

using Lights = std::vector<std::optional<Light>>;

constexpr Light kConstant{0.8, 0.8, 0.8};

Lights lights_of(const TrackedRun& run, std::optional<Light> Sighting::*which) {
  Lights lights;
  for (const Sighting& sighting : run.sightings) lights.push_back(sighting.*which);
  return lights;
}

/// The same answer for every image in which the tracker has one, so that all are judged on the same images.
Lights answered_by(const Lights& answered, const std::function<std::optional<Light>(std::size_t)>& light) {
  Lights lights(answered.size());
  for (std::size_t i = 0; i < answered.size(); ++i) {
    if (answered[i]) lights[i] = light(i);
  }
  return lights;
}

}  // namespace

Result<RunScore> score_of_starts(const Runner& run, const HashedFilm& film, const std::vector<RunStart>& starts) {
  std::vector<RunScore> scores;
  for (const RunStart& start : starts) {
    const auto tracked = run(film, start);
    if (!tracked) return tl::unexpected(tracked.error());
    scores.push_back(score_run(tracked->boxes(), Boxes(film.film.truth.begin() + start.image, film.film.truth.end())));
  }
  return mean_score(scores);
}

Result<double> half_pixel_change(const Runner& run, const HashedFilm& film, double one_pass_iou) {
  double largest = 0.0;
  for (const RunStart& start : half_pixel_starts(*film.film.truth.front())) {
    const auto tracked = run(film, start);
    if (!tracked) return tl::unexpected(tracked.error());
    largest = std::max(largest, std::abs(score(tracked->boxes(), film.film.truth).iou - one_pass_iou));
  }
  return largest;
}

Result<RelitScore> score_relit(const Runner& run, const HashedFilm& changed, const HashedFilm& constant,
                               const Lights& truth) {
  const RunStart start{0, *changed.film.truth.front()};
  const auto under_changing = run(changed, start);
  if (!under_changing) return tl::unexpected(under_changing.error());
  const auto under_constant = run(constant, start);
  if (!under_constant) return tl::unexpected(under_constant.error());
  RelitScore score;
  score.iou = lab::score(under_changing->boxes(), changed.film.truth).iou;
  score.constant_iou = lab::score(under_constant->boxes(), constant.film.truth).iou;
  const Lights exact = lights_of(*under_changing, &Sighting::exact_light);
  score.printed = light_pairs(exact, truth);
  score.of_grid = light_pairs(lights_of(*under_changing, &Sighting::light), truth);
  if (exact.empty() || !exact.front()) return score;
  // Both are absolute here, as the tracker's are: relative to what was assumed at learning.
  const Light assumed = *exact.front();
  Lights constant_answer = answered_by(exact, [](std::size_t) { return kConstant; });
  constant_answer.front() = assumed;
  score.always_0_8 = light_pairs(constant_answer, truth);
  const auto before = [&](std::size_t i) -> std::optional<Light> {
    if (i == 0) return assumed;
    const auto& last = truth[i - 1];
    return last ? std::optional(Light{last->r * assumed.r, last->g * assumed.g, last->b * assumed.b}) : std::nullopt;
  };
  score.always_last = light_pairs(answered_by(exact, before), truth);
  return score;
}

Result<AbsentScore> score_absent(const Runner& run, const HashedFilm& film, const AbsentRange& range,
                                 const Boxes& truth) {
  const auto tracked = run(film, {0, *truth.front()});
  if (!tracked) return tl::unexpected(tracked.error());
  const Boxes boxes = tracked->boxes();
  AbsentScore score;
  const auto iou = [&](std::size_t i) { return truth[i] ? score_image(*truth[i], boxes[i]).iou : 0.0; };
  const auto first = static_cast<std::size_t>(range.first), end = static_cast<std::size_t>(range.end());
  for (std::size_t i = 1; i < end; ++i) {
    const bool claimed = boxes[i].has_value();
    if (i < first) {
      ++score.images_before;
      score.claims_before += claimed;
    } else {
      ++score.images;
      score.false_claims += claimed;
    }
  }
  score.was_on_it = iou(first - 1) >= kAgainIou;
  for (std::size_t i = end; i < std::min(boxes.size(), end + kAgainWithinImages); ++i) {
    if (iou(i) < kAgainIou) continue;
    score.again_after = static_cast<int>(i - end);
    break;
  }
  return score;
}

}  // namespace cgsr::lab
