#pragma once

#include <atomic>
#include <cstdio>

#include <valgrind/callgrind.h>

namespace cgsr {

// Marks that tools/count reads: which instructions belong to which stage of which image. Under callgrind each mark
// talks to it; anywhere else it is a handful of register moves, so the marks stay in the release. Between begin and end
// only the calling thread is collected; what other threads run meanwhile (a capture thread that decodes a video, say)
// is left out, unless they mark stages of their own.

namespace count_marks_detail {
inline std::atomic<unsigned> images{0};
alignas(64) inline thread_local bool open = false;  // aligned: see the linker in cmake/options.cmake
}  // namespace count_marks_detail

/// Starts counting for the calling thread. Not nested: a second begin before the end changes nothing.
inline void count_stage_begin() {
  if (RUNNING_ON_VALGRIND == 0 || count_marks_detail::open) return;
  count_marks_detail::open = true;
  CALLGRIND_TOGGLE_COLLECT;
}

/// Stops counting for the calling thread and books what it executed since count_stage_begin() under `name` and the
/// image under way.
///
/// \param name of the stage; letters, digits, '-', '_' and '.'.
inline void count_stage_end(const char* name) {
  if (RUNNING_ON_VALGRIND == 0 || !count_marks_detail::open) return;
  count_marks_detail::open = false;
  CALLGRIND_TOGGLE_COLLECT;
  char reason[96];
  std::snprintf(reason, sizeof(reason), "cgsr %u %s", count_marks_detail::images.load(std::memory_order_relaxed), name);
  CALLGRIND_DUMP_STATS_AT(reason);
}

/// Ends the image under way: stages that end later belong to the next one.
inline void count_image_end() {
  count_marks_detail::images.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace cgsr
