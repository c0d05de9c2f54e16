#include "platform/memory.h"

#include <alloca.h>
#include <fmt/core.h>
#include <linux/capability.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>

namespace cgsr {
namespace {

bool may_lock_without_limit() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  return (data[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

void touch_pages(volatile std::uint8_t* bytes, std::size_t count) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  for (std::size_t i = 0; i < count; i += page) bytes[i] = 0;
  if (count > 0) bytes[count - 1] = 0;
}

}  // namespace

MemoryReport lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  if (limit.rlim_max == RLIM_INFINITY && limit.rlim_cur != RLIM_INFINITY) {
    limit.rlim_cur = RLIM_INFINITY;
    setrlimit(RLIMIT_MEMLOCK, &limit);
  }
  if (limit.rlim_cur != RLIM_INFINITY && !may_lock_without_limit()) {
    return {
        false,
        fmt::format(
            "memory is not locked: the limit of {} KiB is finite; LimitMEMLOCK=infinity or CAP_IPC_LOCK would grant it",
            limit.rlim_cur / 1024)};
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    return {false, fmt::format("memory is not locked: {}", std::strerror(errno))};
  }
  return {true, "memory is locked, now and for what will be mapped"};
}

void keep_heap_pages() {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
}

void prefault_heap(std::size_t bytes) {
  constexpr std::size_t kBlock = 256 * 1024;  // small enough for any arena to take many, large enough to be quick
  constexpr std::size_t kBlocks = 256;
  std::array<void*, kBlocks> blocks{};
  std::size_t used = 0;
  while (used < kBlocks && bytes > 0) {
    const auto size = std::min(bytes, std::max(kBlock, bytes / (kBlocks - used)));
    blocks[used] = std::malloc(size);
    if (blocks[used] == nullptr) break;
    touch_pages(static_cast<std::uint8_t*>(blocks[used]), size);
    ++used;
    bytes -= size;
  }
  for (std::size_t i = 0; i < used; ++i) std::free(blocks[i]);
}

// Not inlined: its frame is what is touched, and it must be gone when the caller goes on.
__attribute__((noinline)) void prefault_stack(std::size_t bytes) {
  touch_pages(static_cast<std::uint8_t*>(alloca(bytes)), bytes);
}

long page_faults_of_this_thread() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_minflt + usage.ru_majflt;
}

}  // namespace cgsr
