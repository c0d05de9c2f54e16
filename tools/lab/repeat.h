#pragma once

#include "platform/error.h"
#include "tools/lab/report.h"

namespace cgsr::lab {

/// Compares trials that were measured again, with this tree's configuration and sources, with those stored of the same seed. Trials are deterministic, so
/// that a change which moves no figure of a sample of them is one that a table does not measure: a part that its robots do not have, a renaming.
///
/// Compared are rows with a sample per trial, in the digits that the store keeps; every other row, shares above all, only where all trials were repeated. Rows
/// that `again` lacks are not (cost, when nothing was counted).
///
/// \param stored  whose first run begins with these trials.  \param again  of one run, with the first run's seed and no more trials.
/// \return `stored`, now with the hashes of `again` and what was repeated; or the first row that differs, or why nothing can be compared.
Result<Report> repeated(const Report& stored, const Report& again);

}  // namespace cgsr::lab
