#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/sinks/sink.h"

namespace cgsr::sinks {

/// Hands everything to every sink, in the order in which they were added. A sink that fails is ended, the others go on.
class FanOut {
 public:
  /// \return the sink, for whoever has to ask it something later.
  template <class S>
  S& add(std::unique_ptr<S> sink) {
    S& added = *sink;
    sinks_.push_back(std::move(sink));
    return added;
  }

  void on_image(const ImageReport& report);
  void on_missing_image(const runtime::FrameRecord& record);
  void on_control_cycle(const MotionStatus& status);
  void on_switching(const SwitchRecord& record);
  void finish();

  [[nodiscard]] Summary summary() const;
  /// \return what the first sink that failed said; empty: none did.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  template <class Call>
  void each(Call call);

  std::vector<std::unique_ptr<Sink>> sinks_;
  std::vector<std::unique_ptr<Sink>> ended_;  // they still have their say in the summary
  std::string problem_;
};

}  // namespace cgsr::sinks
