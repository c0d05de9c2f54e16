#pragma once

#include <cstdint>

namespace cgsr::test {

/// Counts what the code of a scope takes from malloc and from the kernel's page-fault handler:
///
///     if (!AllocationGuard::counts()) GTEST_SKIP() << "…";
///     warm_up();
///     const AllocationGuard guard;
///     cycle();
///     EXPECT_EQ(guard.allocations(), 0);
///     EXPECT_EQ(guard.page_faults(), 0);
///
/// A test program that links cgsr_allocation_guard has its malloc, calloc, realloc, memalign family and free replaced
/// by ones that count and pass on to glibc; operator new, C libraries and OpenCV end there too. Not under a sanitizer:
/// those bring their own malloc.
///
/// With CGSR_ALLOCATION_TRACE=1 in the environment every counted allocation prints its stack to standard error.
class AllocationGuard {
 public:
  /// \return whether this build counts at all: false under a sanitizer.
  static bool counts();

  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;

  /// Of the calling thread, since this guard was made.
  [[nodiscard]] std::uint64_t allocations() const;
  [[nodiscard]] std::uint64_t frees() const;
  [[nodiscard]] std::uint64_t page_faults() const;

  /// Of every thread.
  [[nodiscard]] std::uint64_t allocations_of_all_threads() const;

 private:
  std::uint64_t allocations_before_;
  std::uint64_t frees_before_;
  std::uint64_t page_faults_before_;
  std::uint64_t all_before_;
};

}  // namespace cgsr::test
