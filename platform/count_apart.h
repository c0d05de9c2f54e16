#pragma once

#include "platform/count_marks.h"

namespace cgsr {

/// Counts what runs while it lives under a name of its own, not under that of the stage within which it runs: work that has a thread of its own on a robot and
/// is done by the stage where there is no such thread. Does nothing where no stage is counted.
class CountApart {
 public:
  /// \param stage  the stage within which it runs.  \param name  its own.  Both outlive this.
  CountApart(const char* stage, const char* name) : stage_(stage), name_(name), counted_(count_marks_detail::open) {
    if (!counted_) return;
    count_stage_end(stage_);
    count_stage_begin();
  }
  ~CountApart() {
    if (!counted_) return;
    count_stage_end(name_);
    count_stage_begin();
  }
  CountApart(const CountApart&) = delete;
  CountApart& operator=(const CountApart&) = delete;

 private:
  const char* stage_;
  const char* name_;
  bool counted_;
};

}  // namespace cgsr
