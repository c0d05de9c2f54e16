#pragma once

#include "src/sinks/statistics_sink.h"

namespace cgsr::sinks {

/// Adds what a run came to, for machines and for people.
void add_run_statistics(const RunStatistics& run, const runtime::StageTable& table, Summary& summary);

}  // namespace cgsr::sinks
