#pragma once

#include <pthread.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"
#include "platform/stop.h"

namespace cgsr {

enum class SchedulingPolicy : std::uint8_t {
  kOther,  ///< the kernel's ordinary fair share
  kFifo,   ///< SCHED_FIFO: runs until it sleeps or a higher priority wants the core
};
std::string_view to_string(SchedulingPolicy policy);

/// One row of the table of threads.
struct ThreadSpec {
  std::string_view name;  ///< at most 15 characters, as ps and top show it; text that outlives the thread
  SchedulingPolicy policy = SchedulingPolicy::kOther;
  int priority = 0;                      ///< 1..89 for kFifo (from 90 on the kernel's own threads starve), 0 for kOther
  std::size_t stack_bytes = 256 * 1024;  ///< bounded, for locked memory counts all of it
  std::size_t heap_bytes = 0;            ///< of its own malloc arena, touched before the body runs and kept
};

/// What took effect: a row of the printed table.
struct ThreadReport {
  ThreadSpec asked;
  SchedulingPolicy policy = SchedulingPolicy::kOther;
  int priority = 0;
  std::string remark;  ///< empty when all was granted; else what was refused and what would grant it
};

/// The threads of a program: started one by one, stopped together. A process without rights runs the same threads under
/// the ordinary policy, and the report says so.
///
/// Threads: one owner calls every member.
class ThreadTable {
 public:
  /// \param stop is requested by stop_and_join. It outlives the table.
  explicit ThreadTable(StopRequest& stop);
  ~ThreadTable();  ///< stop_and_join
  ThreadTable(const ThreadTable&) = delete;
  ThreadTable& operator=(const ThreadTable&) = delete;

  /// Starts a thread; its whole stack is touched before `body` runs. The body returns soon after the stop is requested.
  /// \param wake woken by stop_and_join, for a body that waits; may be nullptr.
  /// \return an error that names the thread: a name or priority out of range, or the system could not create it.
  Result<void> start(const ThreadSpec& spec, std::function<void()> body, WakeUp* wake = nullptr);

  /// Requests the stop, wakes who waits, and joins all, in the reverse order of their start. Idempotent.
  void stop_and_join();

  [[nodiscard]] std::vector<ThreadReport> report() const;

 private:
  struct Entry;
  StopRequest& stop_;
  std::vector<std::unique_ptr<Entry>> entries_;
};

/// \return the table as text: a line per thread, and below it what was refused and what would grant it.
std::string to_text(const std::vector<ThreadReport>& report);

}  // namespace cgsr
