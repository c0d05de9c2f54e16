#include "tests/support/allocation_guard.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <sstream>
#include <thread>
#include <vector>

namespace cgsr::test {
namespace {

class AllocationGuardTest : public testing::Test {
  void SetUp() override {
    if (!AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  }
};

TEST_F(AllocationGuardTest, CountsNothingWhereNothingHappens) {
  static_cast<void>(AllocationGuard().page_faults());  // the pages of its own code are there from now on
  const AllocationGuard guard;
  volatile int sum = 0;
  for (int i = 0; i < 100; ++i) sum = sum + i;
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(guard.frees(), 0U);
  EXPECT_EQ(guard.page_faults(), 0U);
}

TEST_F(AllocationGuardTest, CountsOperatorNewInTheProgram) {
  const AllocationGuard guard;
  auto value = std::make_unique<std::vector<int>>(100);
  value.reset();
  EXPECT_EQ(guard.allocations(), 2U);
  EXPECT_EQ(guard.frees(), 2U);
}

TEST_F(AllocationGuardTest, CountsWhatSharedLibrariesAllocate) {
  std::ostringstream text;  // grows inside libstdc++.so
  const AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) text << i;
  EXPECT_GT(guard.allocations(), 0U);
}

TEST_F(AllocationGuardTest, CountsEveryFormOfAllocation) {
  const AllocationGuard guard;
  void* volatile aligned = nullptr;
  void* block = nullptr;
  ASSERT_EQ(posix_memalign(&block, 64, 128), 0);
  aligned = block;
  void* volatile zeroed = std::calloc(4, 4);
  void* volatile grown = std::realloc(zeroed, 4096);
  void* volatile over_aligned = std::aligned_alloc(64, 64);
  EXPECT_EQ(guard.allocations(), 4U);
  std::free(aligned);
  std::free(grown);
  std::free(over_aligned);
}

TEST_F(AllocationGuardTest, TellsThreadsApart) {
  const AllocationGuard guard;
  std::thread other([] { const std::vector<int> values(1000); });
  const auto mine = guard.allocations();  // making the thread
  other.join();
  EXPECT_EQ(guard.allocations(), mine);
  EXPECT_GT(guard.allocations_of_all_threads(), mine);
}

TEST_F(AllocationGuardTest, CountsPageFaults) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  void* const fresh = mmap(nullptr, 8 * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(fresh, MAP_FAILED);
  madvise(fresh, 8 * page, MADV_NOHUGEPAGE);
  const AllocationGuard guard;
  for (std::size_t i = 0; i < 8; ++i) static_cast<volatile char*>(fresh)[i * page] = 1;
  EXPECT_GE(guard.page_faults(), 8U);
  munmap(fresh, 8 * page);
}

}  // namespace
}  // namespace cgsr::test
