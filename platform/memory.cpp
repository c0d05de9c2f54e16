#include "platform/memory.h"

#include <alloca.h>
#include <fmt/core.h>
#include <linux/capability.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

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

/// Libraries whose code runs for every image; found by how a file's name begins.
constexpr std::array<std::string_view, 10> kFramePath = {
    "ld-linux", "libc.so",   "libm.so",      "libstdc++",      "libgcc_s",
    "libfmt",   "libspdlog", "libturbojpeg", "libopencv_core", "libopencv_imgproc"};

/// A part of the process's memory, as /proc/self/smaps has it.
struct Mapping {
  std::uintptr_t begin = 0;
  std::uintptr_t end = 0;
  std::string permissions;
  std::string file;       ///< empty: anonymous; in brackets: the kernel's name for it.
  std::string data_of;    ///< of an anonymous one that begins where a file's part ends: that file.
  bool is_clean = false;  ///< private, and all of it can be read from the file again.

  [[nodiscard]] bool is_file() const { return !file.empty() && file.front() == '/'; }
};

std::vector<Mapping> mappings() {
  std::vector<Mapping> all;
  std::ifstream smaps("/proc/self/smaps");
  for (std::string line; std::getline(smaps, line);) {
    unsigned long begin = 0;
    unsigned long end = 0;
    unsigned long dirty_kib = 0;
    std::array<char, 5> permissions{};
    int path_at = 0;
    if (std::sscanf(line.c_str(), "%lx-%lx %4s %*s %*s %*s %n", &begin, &end, permissions.data(), &path_at) == 3) {
      Mapping mapping{begin, end, permissions.data(), {}, {}, false};
      if (path_at > 0) mapping.file = line.substr(static_cast<std::size_t>(path_at));
      if (mapping.file.empty() && !all.empty() && all.back().end == begin) {
        mapping.data_of = all.back().is_file() ? all.back().file : all.back().data_of;
      }
      all.push_back(std::move(mapping));
    } else if (!all.empty() && std::sscanf(line.c_str(), "Private_Dirty: %lu kB", &dirty_kib) == 1) {
      // What is shared may be a device's, a camera's buffer for one: its pages were inserted when it was mapped, and the
      // driver cannot bring one back.
      const bool is_private = all.back().permissions.back() == 'p';
      all.back().is_clean = is_private && all.back().is_file() && dirty_kib == 0;
    }
  }
  return all;
}

bool works_on_frame_path(const std::string& file, const std::string& program) {
  const auto name = std::string_view(file).substr(file.rfind('/') + 1);
  return file == program || std::any_of(kFramePath.begin(), kFramePath.end(), [&](std::string_view begins) {
           return name.substr(0, begins.size()) == begins;
         });
}

/// Whether a mapping is to be in memory as a whole.
bool is_needed_whole(const Mapping& mapping, const std::string& program) {
  if (mapping.permissions[0] != 'r' || mapping.file == "[vvar]" || mapping.file == "[vsyscall]") return false;
  if (mapping.is_file()) return works_on_frame_path(mapping.file, program);
  return mapping.data_of.empty() || works_on_frame_path(mapping.data_of, program);
}

std::string program_path() {
  std::array<char, 4096> path{};
  const auto length = readlink("/proc/self/exe", path.data(), path.size() - 1);
  return length > 0 ? std::string(path.data(), static_cast<std::size_t>(length)) : std::string();
}

void* address(const Mapping& mapping) {
  return reinterpret_cast<void*>(mapping.begin);  // NOLINT(performance-no-int-to-ptr): the kernel gives it as text
}

/// Locks all as it is used, and reads what is needed whole. What the loader alone has read of the other libraries goes first: it is read
/// again when it is used. \return false: errno says why.
bool lock_what_is_mapped() {
  const std::string program = program_path();
  const std::vector<Mapping> all = mappings();
  for (const Mapping& mapping : all) {
    if (mapping.is_clean && !is_needed_whole(mapping, program)) {
      madvise(address(mapping), mapping.end - mapping.begin, MADV_DONTNEED);
    }
  }
  if (mlockall(MCL_CURRENT | MCL_ONFAULT) != 0) return false;
  for (const Mapping& mapping : all) {
    if (!is_needed_whole(mapping, program)) continue;
    // The list may be older than the memory: what is gone by now needs no lock.
    if (mlock(address(mapping), mapping.end - mapping.begin) != 0 && errno != ENOMEM) return false;
  }
  return true;
}

/// khugepaged looks through every process each 10 s and copies 2 MB at a time; meanwhile no thread runs on a kernel that is not
/// fully preemptible. Where it is refused, threads are late as before.
void refuse_huge_pages() {
  (void)prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
}

}  // namespace

MemoryReport lock_memory() {
  refuse_huge_pages();
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
  if (!lock_what_is_mapped() || mlockall(MCL_FUTURE) != 0) {
    return {false, fmt::format("memory is not locked: {}", std::strerror(errno))};
  }
  const auto used = memory_in_use();
  return {true,
          fmt::format("memory is locked, now and for what will be mapped: {} MB resident", used.resident / 1'000'000)};
}

MemoryInUse memory_in_use() {
  MemoryInUse used;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    unsigned long kib = 0;
    if (std::sscanf(line.c_str(), "VmRSS: %lu kB", &kib) == 1) used.resident = 1024 * kib;
    if (std::sscanf(line.c_str(), "VmLck: %lu kB", &kib) == 1) used.locked = 1024 * kib;
  }
  return used;
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
