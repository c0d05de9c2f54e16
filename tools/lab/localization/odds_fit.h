#pragma once

#include <array>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "pipeline/localization/correction.h"
#include "pipeline/localization/localizer_parameters.h"

namespace cgsr::lab {

/// What the log-odds of a searched pose's error are linear in, in the order of kOddsTerms.
inline constexpr std::array<std::string_view, 8> kOddsTerms{
    "error_log_odds", "error_per_lead", "error_per_ln_cell",  "error_per_agreement",
    "error_per_ln_m", "error_per_px",   "error_per_ln_match", "error_per_cost"};
using OddsTerms = Eigen::Matrix<double, static_cast<int>(kOddsTerms.size()), 1>;

/// A searched pose, and whether it is more than 5 cm or 1.5 degrees off.
struct OddsSample {
  OddsTerms terms = OddsTerms::Zero();
  bool wrong = false;
  int home = 0;
};

/// \return the terms of a pose that a search found.
OddsTerms odds_terms(const localization::Correction& answer, const localization::GateParameters& parameters);

/// \return the weights that the gate is configured with.
OddsTerms odds_weights(const localization::GateParameters& parameters);

/// Logistic regression by Newton's method, with a ridge of 1 on weights of unit deviation.
/// \return the weights; zero where the samples are all right or all wrong.
OddsTerms fit_odds(std::span<const OddsSample> samples);

/// \return the mean of -ln of the probability that the weights give to what is the case.
double log_loss(std::span<const OddsSample> samples, const OddsTerms& weights);

}  // namespace cgsr::lab
