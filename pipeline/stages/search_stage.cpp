#include "pipeline/stages/search_stage.h"

namespace cgsr::stages {
namespace {

constexpr Duration kMaxObjectsAge = seconds(0.5);  // of the tracker's window size

}  // namespace

std::optional<color::SearchResult> SearchStage::update(WorkBudget& budget, const runtime::Aged<View>& view,
                                                       const runtime::Aged<TrackedObjects>& objects) {
  const View* const now = view.within(Duration::zero());
  if (now == nullptr || !now->reduced) return color::SearchResult{};
  const TrackedObjects* const last = objects.within(kMaxObjectsAge);
  const bool sure = last != nullptr && last->first().object.found && last->first().object.confidence > 0.0 &&
                    last->first().object.confidence >= min_rest_confidence_;
  rests_ = sure && !rests_;
  if (rests_) return std::nullopt;
  return search_.search(*now->reduced, last != nullptr ? last->next_search : first_size_, budget);
}

}  // namespace cgsr::stages
