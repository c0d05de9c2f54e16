#include "pipeline/color/window_search.h"

#include "pipeline/color/exhaustive_search.h"
#include "pipeline/color/similarity.h"

namespace cgsr::color {

struct WindowSearch::State {
  ColorModel model;
  SearchParameters parameters;
  Labels labels;
};

WindowSearch::WindowSearch(std::unique_ptr<State> state) : state_(std::move(state)) {}
WindowSearch::WindowSearch(WindowSearch&&) noexcept = default;
WindowSearch& WindowSearch::operator=(WindowSearch&&) noexcept = default;
WindowSearch::~WindowSearch() = default;

Result<WindowSearch> WindowSearch::create(const ColorModel& model, const SearchParameters& parameters, int, int) {
  if (auto defect = defect_of(model); !defect.empty()) return fail("the colour model cannot be used: " + defect);
  return WindowSearch(std::make_unique<State>(State{model, parameters, labels_of(model)}));
}

const imaging::LabelTable& WindowSearch::labels() const {
  return state_->labels.of_code;
}

tl::expected<SearchResult, SearchFailure> WindowSearch::search(const imaging::ReducedImage& image,
                                                               const SearchRequest& request) {
  return exhaustive_search(state_->model, state_->parameters, image, request);
}

}  // namespace cgsr::color
