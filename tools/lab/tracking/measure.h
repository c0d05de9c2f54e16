#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/lab/tracking/calibration.h"
#include "tools/lab/tracking/light_scores.h"
#include "tools/lab/tracking/painted_over.h"
#include "tools/lab/tracking/relight.h"
#include "tools/lab/tracking/runs.h"
#include "tools/lab/tracking/scores.h"

namespace cgsr::lab {

/// One kind of changing light beside constant light of the same mean.
struct RelitScore {
  double iou = 0.0;
  double constant_iou = 0.0;
  std::vector<LightPair> printed;      ///< the light that falls on the object, as the CSV has it
  std::vector<LightPair> of_grid;      ///< the light of the grid that fits the object's colours best
  std::vector<LightPair> always_0_8;   ///< what answering .8 on every image gives
  std::vector<LightPair> always_last;  ///< what answering the true light of the image before gives
};

struct AbsentScore {
  int images = 0;  ///< in which the object is painted over
  int false_claims = 0;
  int images_before = 0, claims_before = 0;  ///< without the start
  bool was_on_it = false;                    ///< in the last image that showed it before
  std::optional<int> again_after;  ///< images from its return to a box on it; nothing: not within kAgainWithinImages
};

/// One tracker on one sequence; what was not measured is not there.
struct TrackerResult {
  std::string sequence, tracker;
  LearnedObject learned;
  std::string refused;
  std::optional<RunScore> one_pass, spatial, temporal;
  std::optional<double> half_pixel_change;  ///< largest change of IoU
  std::map<LightChange, RelitScore> relit;
  std::optional<AbsentScore> absent;
  std::vector<Claim> claims;  ///< of the one pass, right from IoU .5
};

/// Runs one tracker from one start on one film.
using Runner = std::function<Result<TrackedRun>(const HashedFilm&, const RunStart&)>;

/// The mean score of several runs over a film.
Result<RunScore> score_of_starts(const Runner& run, const HashedFilm& film, const std::vector<RunStart>& starts);

/// The largest change of the one pass's IoU when the first box moves by half a pixel.
Result<double> half_pixel_change(const Runner& run, const HashedFilm& film, double one_pass_iou);

/// \param changed, constant  the film under a changing light and under constant light of the same mean.
/// \param truth  true_lights() of the changing one.
Result<RelitScore> score_relit(const Runner& run, const HashedFilm& changed, const HashedFilm& constant,
                               const std::vector<std::optional<Light>>& truth);

/// \param film  without the object in `range`. \param truth  where it would be, and is before and after.
Result<AbsentScore> score_absent(const Runner& run, const HashedFilm& film, const AbsentRange& range,
                                 const Boxes& truth);

}  // namespace cgsr::lab
