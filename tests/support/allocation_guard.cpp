#include "tests/support/allocation_guard.h"

#include <execinfo.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define CGSR_COUNTS_ALLOCATIONS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CGSR_COUNTS_ALLOCATIONS 0
#endif
#endif
#ifndef CGSR_COUNTS_ALLOCATIONS
#define CGSR_COUNTS_ALLOCATIONS 1
#endif

namespace cgsr::test {
namespace {

struct alignas(64) Counts {  // aligned: see the linker in cmake/options.cmake
  std::uint64_t allocations = 0;
  std::uint64_t frees = 0;
  int guards = 0;
  bool printing = false;
};
constinit thread_local Counts of_this_thread;  // constant-initialised: malloc is called before anything else is
constinit std::atomic<std::uint64_t> of_all_threads{0};

bool tracing() {
  static const bool wanted = std::getenv("CGSR_ALLOCATION_TRACE") != nullptr;
  return wanted;
}

void print_stack() {
  of_this_thread.printing = true;
  std::array<void*, 32> frames{};
  const int depth = backtrace(frames.data(), static_cast<int>(frames.size()));
  backtrace_symbols_fd(frames.data(), depth, STDERR_FILENO);
  constexpr char kLine[] = "---- one allocation\n";
  static_cast<void>(!write(STDERR_FILENO, kLine, sizeof(kLine) - 1));
  of_this_thread.printing = false;
}

[[maybe_unused]] void count_allocation() {
  if (of_this_thread.printing) return;
  ++of_this_thread.allocations;
  of_all_threads.fetch_add(1, std::memory_order_relaxed);
  if (of_this_thread.guards > 0 && tracing()) print_stack();
}

[[maybe_unused]] void count_free() {
  if (!of_this_thread.printing) ++of_this_thread.frees;
}

std::uint64_t page_faults_so_far() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
}

}  // namespace

bool AllocationGuard::counts() {
  return CGSR_COUNTS_ALLOCATIONS != 0;
}

AllocationGuard::AllocationGuard()
    : allocations_before_(of_this_thread.allocations),
      frees_before_(of_this_thread.frees),
      page_faults_before_(page_faults_so_far()),
      all_before_(of_all_threads.load(std::memory_order_relaxed)) {
  static_cast<void>(tracing());
  ++of_this_thread.guards;
}

AllocationGuard::~AllocationGuard() {
  --of_this_thread.guards;
}

std::uint64_t AllocationGuard::allocations() const {
  return of_this_thread.allocations - allocations_before_;
}

std::uint64_t AllocationGuard::frees() const {
  return of_this_thread.frees - frees_before_;
}

std::uint64_t AllocationGuard::page_faults() const {
  return page_faults_so_far() - page_faults_before_;
}

std::uint64_t AllocationGuard::allocations_of_all_threads() const {
  return of_all_threads.load(std::memory_order_relaxed) - all_before_;
}

}  // namespace cgsr::test

#if CGSR_COUNTS_ALLOCATIONS
// The names under which glibc keeps the originals. The program's definitions below take precedence over those of every
// shared library. NOLINTBEGIN(bugprone-reserved-identifier, readability-identifier-naming,
// readability-inconsistent-declaration-parameter-name)
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  cgsr::test::count_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  cgsr::test::count_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* block, std::size_t size) {
  cgsr::test::count_allocation();
  return __libc_realloc(block, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  cgsr::test::count_allocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  void* const allocated = memalign(alignment, size);
  if (allocated == nullptr) return ENOMEM;
  *block = allocated;
  return 0;
}

void free(void* block) {
  if (block != nullptr) cgsr::test::count_free();
  __libc_free(block);
}
}
// NOLINTEND(bugprone-reserved-identifier, readability-identifier-naming,
// readability-inconsistent-declaration-parameter-name)
#endif
