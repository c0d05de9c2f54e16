#pragma once

#include "platform/error.h"
#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// Counts instructions of ours while tracking, on six named sequences of the recorded data scaled to 640x480, 60 images each after the one
/// learned from, and of each peer on the first ten of these. Search, which finds the object again, is in it.
/// \return which sequence is not there; or what went wrong while counting.
Result<void> add_cost_rows(const Setting& setting, Report& report);

}  // namespace cgsr::lab
