#pragma once

#include <memory>

#include <tl/expected.hpp>

#include "pipeline/color/learn/color_model.h"
#include "pipeline/color/search/search_types.h"
#include "pipeline/imaging/reduce.h"
#include "platform/error.h"

namespace cgsr::color {

/// Alg. 3.2: every window of several sizes at every stride, every learned histogram, the least divergence. It finds what
/// exhaustive_search finds, to the last bit, by branch and bound.
///
/// Threads: one. Memory is reserved by create; search never allocates.
class WindowSearch {
 public:
  /// \param max_width_px, max_height_px  the largest camera image that will come.
  /// \return an error in words: a defective model or parameters that cannot be.
  static Result<WindowSearch> create(const ColorModel& model, const SearchParameters& parameters, int max_width_px,
                                     int max_height_px);
  WindowSearch(WindowSearch&&) noexcept;
  WindowSearch& operator=(WindowSearch&&) noexcept;
  ~WindowSearch();

  /// \return the table to make label images with (imaging::reduce): labels of the bins that occur in a learned histogram, 0 the others.
  [[nodiscard]] const imaging::LabelTable& labels() const;

  /// Searches one image. \param image  reduced with labels().
  tl::expected<SearchResult, SearchFailure> search(const imaging::ReducedImage& image, const SearchRequest& request);

  /// Begins to search one image over several calls of advance(), which end where search() without a budget ends, to the last bit.
  /// \param image  reduced with labels(); stays as it is until the search is at its end. \param request  its budget is not asked.
  tl::expected<void, SearchFailure> begin(const imaging::ReducedImage& image, const SearchRequest& request);
  /// Goes on with the search that was begun. \param budget  asked before each group of windows that is looked into.
  /// \return whether it is at its end; false: the budget refused, the next call goes on from there.
  bool advance(WorkBudget& budget);
  /// \return what the search that was begun has found so far.
  [[nodiscard]] const SearchResult& result() const;

 private:
  struct State;
  explicit WindowSearch(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::color
