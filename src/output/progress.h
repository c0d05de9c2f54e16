#pragma once

#include <chrono>
#include <string_view>

namespace cgsr::app {

/// One line on a terminal that is written over as work goes on; nothing where standard error is no terminal.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// At most five times a second; calls in between cost a clock read.
  void show(std::string_view line);

 private:
  bool terminal_;
  bool shown_ = false;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace cgsr::app
