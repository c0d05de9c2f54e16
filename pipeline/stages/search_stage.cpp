#include "pipeline/stages/search_stage.h"

namespace cgsr::stages {
namespace {

constexpr Duration kMaxObjectsAge = seconds(0.5);  // of the tracker's window size

}  // namespace

color::SearchResult SearchStage::update(WorkBudget& budget, const runtime::Aged<View>& view,
                                        const runtime::Aged<TrackedObjects>& objects) {
  const View* const now = view.within(Duration::zero());
  if (now == nullptr || !now->reduced) return {};
  const TrackedObjects* const last = objects.within(kMaxObjectsAge);
  return search_.search(*now->reduced, last != nullptr ? last->next_search : first_size_, budget);
}

}  // namespace cgsr::stages
