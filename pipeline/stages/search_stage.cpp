#include "pipeline/stages/search_stage.h"

namespace cgsr::stages {

color::SearchResult SearchStage::update(WorkBudget& budget, const runtime::Aged<View>& view,
                                        const runtime::Aged<TrackedObjects>& objects) {
  const View* const now = view.within(Duration::zero());
  if (now == nullptr || !now->reduced) return {};
  return search_.search(*now->reduced, objects.ever() ? objects.value.next_search : first_size_, budget);
}

}  // namespace cgsr::stages
