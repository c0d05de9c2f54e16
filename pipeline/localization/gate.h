#pragma once

#include "pipeline/localization/alternate.h"
#include "pipeline/localization/correction.h"
#include "pipeline/localization/localizer_parameters.h"

namespace cgsr::localization {

/// \return the covariance of an estimate: what the matches and the prior leave open, and the map's own error.
geometry::Matrix6d covariance_of(const Estimate& estimate, const LocalizerParameters& parameters);

/// What speaks for an estimate: how much is explained, how far ahead of the next best pose it is, less how far it is from the prior.
float evidence_of(const Estimate& estimate, float lead);

/// The first test that an estimate does not pass, or kNone. A wrong correction is worse than none.
Reason gate(const Estimate& estimate, float lead, const geometry::Matrix6d& covariance,
            const LocalizerParameters& parameters);

}  // namespace cgsr::localization
