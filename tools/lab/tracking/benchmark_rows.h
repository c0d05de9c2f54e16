#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/lab/report.h"
#include "tools/lab/tracking/choices.h"
#include "tools/lab/tracking/folds.h"
#include "tools/lab/tracking/measure.h"

namespace cgsr::lab {

/// All that was measured: one entry per sequence and tracker, the sequences in order, the trackers in that of trackers().
using BenchmarkResults = std::vector<TrackerResult>;

/// The results of one tracker, in the order of the sequences.
std::vector<const TrackerResult*> results_of(const BenchmarkResults& results, std::string_view tracker);

/// One pass and robustness: a line per tracker, ours minus CSRT, ours beside the better of KCF and CSRT, per fold, per sequence.
void add_score_rows(const BenchmarkResults& results, const Folds& folds, std::uint64_t seed, Report& report);

/// The light estimate of the relit variants beside the truth, per kind of change, with a stripe of each.
void add_light_rows(const BenchmarkResults& results, Report& report);

/// Relit variants: IoU beside constant light per kind of change, and the light estimate.
void add_relit_rows(const BenchmarkResults& results, std::uint64_t seed, Report& report);

/// Object absent: false claims, found again, claims while present.
void add_absent_rows(const BenchmarkResults& results, Report& report);

/// Confidence: calibration error of all claims and of each fold's, and the reliability diagram.
void add_confidence_rows(const BenchmarkResults& results, const Folds& folds, Report& report);

/// Success and precision curves of the one pass and of both robustness parts.
void add_curves(const BenchmarkResults& results, Report& report);

/// The figures of ours, for the table of choices.
Figures figures_of(const BenchmarkResults& results);

}  // namespace cgsr::lab
