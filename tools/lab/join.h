#pragma once

#include "platform/error.h"
#include "tools/lab/report.h"

namespace cgsr::lab {

/// Joins two reports of one table that were measured with the same configuration and the same sources: its rows are then those of the trials of
/// both. What was repeated of `earlier` stays told. Rows that only one of them has are kept as they are; notes are those of `later`.
///
/// \return why they cannot be joined: another table, configuration or sources, or a seed that is in both.
Result<Report> joined(const Report& earlier, const Report& later);

}  // namespace cgsr::lab
