#pragma once

#include <cstdint>
#include <string_view>

#include "pipeline/color/ball/ball_model.h"
#include "pipeline/color/ball/image_part.h"
#include "pipeline/color/search/window_search.h"
#include "platform/error.h"
#include "platform/work_budget.h"

namespace cgsr::color {

/// A piece of work of several units, asked for over as many images as it takes: however few an image has, it is done in the end. Ours.
class Installments {
 public:
  /// \return whether all `units` of it have been granted, in this image and those before; then the next piece begins.
  bool pay(int units, WorkBudget& budget);

  /// What was paid and is not needed counts towards the next payment.
  void give_back(int units) { paid_ += units; }

 private:
  int paid_ = 0;
};

/// The two searches of 5.3 for a ball: bright histograms everywhere, then dark ones where there may be shade. Where a budget ends them they go
/// on in the next image: each search keeps the labels of the image that it began with, and the dark one begins with the image in which the bright
/// one has come to its end.
/// Spreading them over images is ours; with the budget that they ask for they are the two whole searches of one image.
///
/// Threads: one. Memory is reserved by create; advance never allocates.
class BallSearch {
 public:
  enum class Progress : std::uint8_t {
    kImpossible,  ///< the image cannot be searched.
    kUnderWay,    ///< the budget refused.
    kAtEnd,
  };

  /// \return an error in words: parameters or a model that cannot be.
  static Result<BallSearch> create(const BallModel& ball, const SearchParameters& parameters, int max_width_px,
                                   int max_height_px);

  /// Begins with this image, or goes on; at the end it stays there until abandon(). \param mask  over this image; empty: dark histograms are searched everywhere.
  /// \param request  of either search, read when it begins. \param min_ball_px  the ball's smallest diameter.
  /// \param budget  asked for a unit for every kPixelsPerUnit before each of the two searches begins, and for one before each
  ///        group of windows.
  Progress advance(const ImageView& image, const ShadeMaskView& mask, const SearchRequest& request, double min_ball_px,
                   WorkBudget& budget);
  /// Ends the search wherever it is: the next one begins anew. What was found can be read until then.
  void abandon() { phase_ = Phase::kNone; }

  /// What has been found, in pixels of the image in which each search began. Empty before that.
  [[nodiscard]] const SearchResult& bright() const { return bright_matches_; }
  [[nodiscard]] const SearchResult& dark() const { return dark_matches_; }

  [[nodiscard]] const imaging::LabelTable& bright_table() const { return bright_.labels(); }
  [[nodiscard]] const imaging::LabelTable& dark_table() const { return dark_.labels(); }

  static constexpr int kPixelsPerUnit =
      680;  ///< labels, sums and first groups of so many cost what a group of windows costs.

 private:
  enum class Phase : std::uint8_t { kNone, kBright, kBeforeDark, kDark, kAtEnd };

  BallSearch(WindowSearch&& bright, WindowSearch&& dark, int max_width_px, int max_height_px);
  bool begin_bright(const ImageView& image, const SearchRequest& request, double min_ball_px);
  bool begin_dark(const ImageView& image, const ShadeMaskView& mask, const SearchRequest& request);

  WindowSearch bright_;
  WindowSearch dark_;
  imaging::ReducedImage bright_labels_;
  imaging::ReducedImage dark_labels_;  // of dark_part_
  ImagePart dark_part_;
  Phase phase_ = Phase::kNone;
  Installments start_;
  SearchResult bright_matches_;
  SearchResult dark_matches_;
};

constexpr std::string_view to_string(BallSearch::Progress progress) {
  switch (progress) {
    case BallSearch::Progress::kImpossible:
      return "impossible";
    case BallSearch::Progress::kUnderWay:
      return "under way";
    case BallSearch::Progress::kAtEnd:
      return "at its end";
  }
  return "unknown";
}

}  // namespace cgsr::color
