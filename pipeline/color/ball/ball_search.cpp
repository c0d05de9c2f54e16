#include "pipeline/color/ball/ball_search.h"

#include <utility>

namespace cgsr::color {
namespace {

int start_units(int width_px, int height_px) {
  return 1 + width_px * height_px / BallSearch::kPixelsPerUnit;
}

}  // namespace

bool Installments::pay(int units, WorkBudget& budget) {
  for (; paid_ < units; ++paid_) {
    if (!budget.grant()) return false;
  }
  paid_ = 0;
  return true;
}

BallSearch::BallSearch(WindowSearch&& bright, WindowSearch&& dark, int max_width_px, int max_height_px)
    : bright_(std::move(bright)),
      dark_(std::move(dark)),
      bright_labels_(max_width_px, max_height_px),
      dark_labels_(max_width_px, max_height_px) {}

Result<BallSearch> BallSearch::create(const BallModel& ball, const SearchParameters& parameters, int max_width_px,
                                      int max_height_px) {
  auto bright = WindowSearch::create(ball.bright, parameters, max_width_px, max_height_px);
  if (!bright) return tl::unexpected(bright.error());
  auto dark = WindowSearch::create(ball.dark, parameters, max_width_px, max_height_px);
  if (!dark) return tl::unexpected(dark.error());
  return BallSearch(std::move(*bright), std::move(*dark), max_width_px, max_height_px);
}

bool BallSearch::begin_bright(const ImageView& image, const SearchRequest& request, double min_ball_px) {
  bright_matches_ = {};
  dark_matches_ = {};
  const int factor = imaging::reduction_for(image.width_px, image.height_px, min_ball_px);
  if (!imaging::reduce(image, factor, bright_.labels(), bright_labels_)) return false;
  phase_ = bright_.begin(bright_labels_, request) ? Phase::kBright : Phase::kBeforeDark;
  return true;
}

/// \return whether there is something to search.
bool BallSearch::begin_dark(const ImageView& image, const ShadeMaskView& mask, const SearchRequest& request) {
  if (dark_part_.width == 0) return false;
  if (!imaging::reduce(cut(image, dark_part_), bright_labels_.factor, dark_.labels(), dark_labels_)) return false;
  if (!mask.empty()) keep_only(Kept::kShaded, mask, image, dark_part_, dark_labels_);
  return dark_.begin(dark_labels_, request).has_value();
}

BallSearch::Progress BallSearch::advance(const ImageView& image, const ShadeMaskView& mask,
                                         const SearchRequest& request, double min_ball_px, WorkBudget& budget) {
  if (phase_ == Phase::kNone) {
    if (!start_.pay(start_units(image.width_px, image.height_px), budget)) return Progress::kUnderWay;
    if (!begin_bright(image, request, min_ball_px)) return Progress::kImpossible;
  }
  if (phase_ == Phase::kBright) {
    const bool at_end = bright_.advance(budget);
    bright_matches_ = bright_.result();
    if (!at_end) return Progress::kUnderWay;
    phase_ = Phase::kBeforeDark;
  }
  if (phase_ == Phase::kBeforeDark) {
    dark_part_ = mask.empty() ? ImagePart{0, 0, image.width_px, image.height_px} : shaded_part(mask, image);
    if (!start_.pay(start_units(dark_part_.width, dark_part_.height), budget)) return Progress::kUnderWay;
    phase_ = begin_dark(image, mask, request) ? Phase::kDark : Phase::kAtEnd;
  }
  if (phase_ == Phase::kDark) {
    const bool at_end = dark_.advance(budget);
    dark_matches_ = dark_.result();
    for (Match& match : dark_matches_.matches) {
      match.box.x += dark_part_.left;
      match.box.y += dark_part_.top;
    }
    if (!at_end) return Progress::kUnderWay;
    phase_ = Phase::kAtEnd;
  }
  return Progress::kAtEnd;
}

}  // namespace cgsr::color
