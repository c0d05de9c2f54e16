#include "pipeline/color/tracker.h"

#include <algorithm>

#include <utility>

#include "pipeline/color/window_search.h"

namespace cgsr::color {

struct Tracker::State {
  ColorModel model;
  TrackParameters parameters;
  WindowSearch search;
  std::optional<Box> last;
};

Result<Tracker> Tracker::create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                int max_height_px) {
  auto settings = parameters.search;
  if (parameters.mode == TrackMode::kPlain) {
    settings.weights = BinWeights::kPlain;
    settings.sizes = 1;
  }
  auto search = WindowSearch::create(model, settings, max_width_px, max_height_px);
  if (!search) return tl::unexpected(search.error());
  return Tracker(std::make_unique<State>(State{model, parameters, std::move(*search), std::nullopt}));
}

Tracker::Tracker(std::unique_ptr<State> state) : state_(std::move(state)) {}
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;
Tracker::~Tracker() = default;

const imaging::LabelTable& Tracker::labels() const {
  return state_->search.labels();
}

int Tracker::reduction(int width_px, int height_px) const {
  return imaging::reduction_for(width_px, height_px, std::min(state_->model.width_px, state_->model.height_px));
}

void Tracker::place(const Box& box) {
  state_->last = box;
}

TrackedObject Tracker::track(const ImageView& /*image*/, const imaging::ReducedImage& reduced, WorkBudget& budget) {
  SearchRequest request;
  const bool resize = state_->parameters.mode == TrackMode::kFull && state_->last;
  request.width_px = resize ? state_->last->width : state_->model.width_px;
  request.height_px = resize ? state_->last->height : state_->model.height_px;
  request.max_divergence = state_->parameters.max_divergence;
  request.budget = &budget;
  const auto result = state_->search.search(reduced, request);
  if (!result || result->count == 0) return {};
  const Match& best = result->matches.front();
  state_->last = best.box;
  return {true, best.box, best.divergence, state_->model.lights[static_cast<std::size_t>(best.light)]};
}

}  // namespace cgsr::color
