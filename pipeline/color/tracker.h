#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "pipeline/color/color_model.h"
#include "pipeline/color/search_types.h"
#include "pipeline/imaging/reduce.h"
#include "platform/box.h"
#include "platform/error.h"
#include "platform/image_view.h"
#include "platform/parameters.h"
#include "platform/work_budget.h"

namespace cgsr::color {

enum class TrackMode : std::uint8_t {
  kPlain,  ///< Alg. 3.2 as the dissertation has it: one size, plain bins, the best window below the threshold, no prior.
  kFull,   ///< ours: see the README of this folder.
};

inline constexpr std::array kTrackModeNames{
    Named<TrackMode>{"plain", TrackMode::kPlain},
    Named<TrackMode>{"full", TrackMode::kFull},
};

struct TrackParameters {
  TrackMode mode = TrackMode::kFull;
  double max_divergence = 0.30;
  SearchParameters search;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.choice("mode", self.mode, kTrackModeNames, "plain: the dissertation's Alg. 3.2; full: ours");
    visit.number("max_divergence", self.max_divergence, Range{0.0, 0.7}, "nat",
                 "a window farther than this from every learned histogram is not the object");
    visit.section("search", self.search, "the search over the whole image");
  }
};

/// Where the object is in one image.
struct TrackedObject {
  bool found = false;
  Box box;                  ///< camera pixels; read only when found, as all below.
  double divergence = 0.0;  ///< [nat] from the learned histogram under the matched light.
  Light light;  ///< the light of the grid that matched best (Alg. 3.2, line 10); never preferred in the next image.
};

/// Finds a learned object in image after image (chapter 3).
///
/// Threads: one. Memory is reserved by create; track never allocates.
class Tracker {
 public:
  /// \param max_width_px, max_height_px  the largest camera image that will come.
  static Result<Tracker> create(const ColorModel& model, const TrackParameters& parameters, int max_width_px,
                                int max_height_px);
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;
  ~Tracker();

  /// The table and the factor to reduce the next image with (imaging::reduce). \param width_px, height_px  of that image.
  [[nodiscard]] const imaging::LabelTable& labels() const;
  [[nodiscard]] int reduction(int width_px, int height_px) const;

  /// Says where the object is known to be, as after learning from the image before: a prior for the next image.
  void place(const Box& box);

  /// One image. \param image  as the camera sent it. \param reduced  the same, reduced with labels() and reduction().
  TrackedObject track(const ImageView& image, const imaging::ReducedImage& reduced, WorkBudget& budget);

 private:
  struct State;
  explicit Tracker(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace cgsr::color
