#pragma once

#include <optional>

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/correction.h"
#include "pipeline/localization/localizer_parameters.h"

namespace cgsr::localization {

/// \return what the matches and the prior leave open of an estimate, in the map as it is: the inverse of Solution::information, of the
///         step that geometry::moved() takes, metres and radians.
geometry::Matrix6d covariance_in_map(const Estimate& estimate);

/// \return the same in the world: the map's own error is added. An image's answer is told with it; but the next image sees the same map, and
/// a belief that took it for news at each would soon hold nothing of what the odometry and earlier views know.
geometry::Matrix6d with_map_error(const geometry::Matrix6d& covariance_in_map, const LocalizerParameters& parameters);

/// How an estimate stands among the poses that a search tried.
struct Standing {
  float lead = 0.0F;    ///< in rank, ahead of the next best pose that is another one.
  double cells = 1.0;   ///< how many poses that differ the prior holds (Search::cells).
  bool narrow = false;  ///< the prior is hardly wider than one pose.
};

/// Whether two poses are one answer: which of them is taken would be no great error.
bool same_answer(const geometry::Pose& a, const geometry::Pose& b, const GateParameters& parameters);

/// What speaks for one of the few poses that a narrow prior holds: how well image and map agree there, how far ahead of the next best pose it is,
/// less how far it is from the prior.
float evidence_of(const Estimate& estimate, const Standing& standing, const GateParameters& parameters);

/// The log-odds that a pose that a search found is more than 5 cm or 1.5 degrees off: from how well image and map agree there, its lead, how
/// many poses there were to choose from, what its matches leave open, how many they are and how well they and the prior fit.
/// Ours: a logistic regression over what searches found in generated homes and shipped worlds, with right and wrong maps (README.md has the counts).
double log_odds_of_error(const Estimate& estimate, const Standing& standing, const GateParameters& parameters);

/// The first test that an estimate does not pass, or kNone. A wrong correction is worse than none.
/// Ours: Alg. 4.1 has no gate.
/// After the limits on expected edges, matches, residual and distance to the prior: a searched pose is accepted by its standard deviations and the
/// log-odds of its error, one of the few poses of a narrow prior by its evidence and standard deviations.
/// \param standing  none: the pose was followed from a narrow prior. How uncertain it may be then is the tracker's to say.
Reason gate(const Estimate& estimate, const std::optional<Standing>& standing, const geometry::Matrix6d& covariance,
            const LocalizerParameters& parameters);

}  // namespace cgsr::localization
