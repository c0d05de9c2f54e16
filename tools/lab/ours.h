#pragma once

#include <memory>

#include "src/config/color.h"
#include "tools/lab/box_tracker.h"

namespace cgsr::lab {

/// What our tracker is told about where the object is when it starts.
enum class Start {
  kWhereLearned,  ///< the next image follows the learned one.
  kAnywhere,      ///< the next image is unrelated: no prior.
};

/// Chapter 3 behind the lab's face. Its stages are marked for tools/count: labels (imaging::reduce), search (Alg. 3.2) and
/// track (everything else).
std::unique_ptr<BoxTracker> make_ours(const config::Color& configuration, Start start = Start::kWhereLearned);

/// The same in the dissertation's own mode.
std::unique_ptr<BoxTracker> make_plain(const config::Color& configuration, Start start = Start::kWhereLearned);

}  // namespace cgsr::lab
