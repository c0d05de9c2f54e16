#pragma once

#include <cstddef>
#include <string>

namespace cgsr {

struct MemoryReport {
  bool locked = false;
  std::string text;  ///< one line: what took effect, or what was refused and what would grant it
};

/// Locks the process's memory, so that what the robot's threads use is never read from disk again:
/// - the heap, the program, and the libraries that work on the frame path: read now, and kept;
/// - whatever is mapped later (threads' stacks, a growing heap): likewise, whole;
/// - the other libraries' files (video decoders, geographic formats and the like, 200 MB behind OpenCV's modules): what of them was
///   used is kept, what never is takes no memory.
///
/// Call it at boot, when all libraries are loaded and before the threads are created. Under a finite RLIMIT_MEMLOCK without CAP_IPC_LOCK it
/// refuses: such a lock succeeds and then makes a later thread or allocation fail.
MemoryReport lock_memory();

/// What the kernel counts of this process now, in bytes (VmRSS and VmLck of /proc/self/status); 0 where it does not say.
struct MemoryInUse {
  std::size_t resident = 0;
  std::size_t locked = 0;
};
MemoryInUse memory_in_use();

/// Tells malloc to keep what it ever got: no page returns to the kernel (M_TRIM_THRESHOLD), no block is mapped by
/// itself and unmapped when freed (M_MMAP_MAX). After a warm-up cycle, library calls that must allocate then do so
/// without page faults. Call it before the first thread.
void keep_heap_pages();

/// Touches `bytes` of the calling thread's malloc arena and gives them back to it. Needs keep_heap_pages(). At most 32
/// MiB outside the main thread: a secondary arena's segment is 64 MiB.
void prefault_heap(std::size_t bytes);

/// Touches `bytes` of the calling thread's stack below this call.
void prefault_stack(std::size_t bytes);

/// \return page faults of the calling thread so far, those without disk access included.
long page_faults_of_this_thread();

}  // namespace cgsr
