#pragma once

#include "platform/work_budget.h"

namespace cgsr::localization {

/// Ours: what localization asks a budget for. A unit is about 0.7 million instructions (x86-64, SSE2). What perceives the edges of an image, 3.4 million,
/// comes before all units. Counted in the home's map (553 surfaces, 1058 edges) with callgrind; docs/threads.md has the figures.
inline constexpr int kLookUnits =
    5;  ///< determine the visible edges from a pose: 3.65 million where the map fills the view.
inline constexpr int kRoundUnits = 1;  ///< project, match and solve once, or project and score a hypothesis.
inline constexpr int kFieldUnits =
    5;  ///< prepare an image so that hypotheses are scored without matching: 3.25 million.
/// With fewer units an image a search would never go on.
inline constexpr int kMinSearchUnits = kLookUnits + kRoundUnits;

/// \return whether so many units may be done. The last of them may be refused: then none is done.
inline bool granted(WorkBudget& budget, int units) {
  for (int i = 0; i < units; ++i) {
    if (!budget.grant()) return false;
  }
  return true;
}

}  // namespace cgsr::localization
