#pragma once

#include <array>
#include <cstddef>

#include "platform/parameters.h"

namespace cgsr::color {

/// How Clutter forgets, and what is asked beyond it.
struct ClutterParameters {
  double before_any = 1.5;
  double forgetting = 0.01;
  double margin = 1.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("before_any", self.before_any, {-100.0, 100.0}, "",
                 "The log-odds of presence that other things are taken to show before any was looked at.");
    visit.number("forgetting", self.forgetting, {0.0, 10.0}, "",
                 "What the strongest log-odds of other things lose with each image in which others were looked at.");
    visit.number("margin", self.margin, {-100.0, 100.0}, "",
                 "How far the log-odds of a place elsewhere must exceed those that other things showed.");
  }
};

/// The strongest evidence of presence that anything but the object showed in this scene: what the object has to exceed to be found again.
/// A scene with somebody who looks alike shows more of it than an empty road. It counts what was looked at beside the object while that was
/// followed, and what was looked at and not believed while it was lost; the latter after some images only, for it may have been the
/// object on its way back. All before a size is fitted. Ours: the dissertation (3.2.2) asks the same everywhere.
class Clutter {
 public:
  explicit Clutter(const ClutterParameters& parameters) : parameters_(parameters), level_(parameters.before_any) {}

  /// Nothing but the object was looked at yet.
  void reset();

  /// \param log_odds  of something that is surely not the object.
  void add(double log_odds);

  /// \param log_odds  the largest of what was looked at in one image and may be the object: it counts after ten more.
  void add_pending(double log_odds);

  /// What was looked at last was the object: it does not count.
  void discard_pending() { pending_count_ = 0; }

  /// \return the log-odds of presence that a place elsewhere must have.
  [[nodiscard]] double min_log_odds() const { return level_ + parameters_.margin; }
  /// \return what speaks against a place where it was lost: things that are no better than nothing count as nothing.
  [[nodiscard]] double level() const { return level_ > 0.0 ? level_ : 0.0; }

 private:
  static constexpr std::size_t kPending = 10;  // images

  ClutterParameters parameters_;
  double level_;
  std::array<double, kPending> pending_{};
  std::size_t pending_count_ = 0;  ///< of all that add_pending() was told since discard_pending().
};

}  // namespace cgsr::color
