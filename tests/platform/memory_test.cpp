#include "platform/memory.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

#include "tests/support/allocation_guard.h"

namespace cgsr {
namespace {

using testing::ExitedWithCode;

class MemoryDeathTest : public testing::Test {
 protected:
  void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

// In a process of its own: the limit cannot be raised again.
[[noreturn]] void lock_without_rights() {
  const rlimit small{64 * 1024, 64 * 1024};
  setrlimit(RLIMIT_MEMLOCK, &small);
  if (setuid(65534) != 0 && geteuid() == 0) std::exit(2);
  const auto report = lock_memory();
  const bool honest = !report.locked && report.text.find("64 KiB") != std::string::npos &&
                      report.text.find("LimitMEMLOCK=infinity") != std::string::npos;
  std::exit(honest ? 0 : 1);
}

TEST_F(MemoryDeathTest, SaysThatItCouldNotLockAndWhatWouldHelp) {
  EXPECT_EXIT(lock_without_rights(), ExitedWithCode(0), "");
}

[[noreturn]] void lock_with_rights() {
  const auto report = lock_memory();
  if (prctl(PR_GET_THP_DISABLE, 0, 0, 0, 0) != 1) std::exit(4);
  if (!report.locked) std::exit(report.text.empty() ? 1 : 3);
  std::exit(report.text.find("is locked") == std::string::npos ? 1 : 0);
}

TEST_F(MemoryDeathTest, LocksWherePermitted) {
  EXPECT_EXIT(
      lock_with_rights(),
      [](int status) {
        return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || (WEXITSTATUS(status) == 3 && geteuid() != 0));
      },
      "");
}

// As a camera's buffers are mapped; of these a page that was given back could not be had again.
[[noreturn]] void lock_beside_a_shared_mapping() {
  constexpr std::size_t kBytes = 64 * 4096;
  std::FILE* const file = std::tmpfile();
  if (file == nullptr || ftruncate(fileno(file), kBytes) != 0) std::exit(2);
  void* const mapped = mmap(nullptr, kBytes, PROT_READ, MAP_SHARED | MAP_POPULATE, fileno(file), 0);
  if (mapped == MAP_FAILED) std::exit(2);
  if (!lock_memory().locked) std::exit(3);
  const long before = page_faults_of_this_thread();
  for (std::size_t i = 0; i < kBytes; i += 4096) (void)static_cast<volatile const char*>(mapped)[i];
  std::exit(page_faults_of_this_thread() == before ? 0 : 1);
}

TEST_F(MemoryDeathTest, KeepsThePagesOfWhatIsShared) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer's own pages fault too";
  EXPECT_EXIT(
      lock_beside_a_shared_mapping(),
      [](int status) {
        return WIFEXITED(status) && (WEXITSTATUS(status) == 0 || (WEXITSTATUS(status) == 3 && geteuid() != 0));
      },
      "");
}

void touch(void* block, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; i += 4096) static_cast<volatile char*>(block)[i] = 1;
}

/// Page faults of the second of two equal bouts of large allocations, as a library makes them for each image.
long faults_of_a_warm_cycle() {
  const auto cycle = [] {
    for (const std::size_t bytes : {300'000U, 1'200'000U, 40'000U}) {
      void* const block = std::malloc(bytes);
      touch(block, bytes);
      std::free(block);
    }
  };
  cycle();
  const long before = page_faults_of_this_thread();
  cycle();
  return page_faults_of_this_thread() - before;
}

[[noreturn]] void compare_heaps() {
  const long careless = faults_of_a_warm_cycle();  // the large blocks are mapped and unmapped every time
  keep_heap_pages();
  const long kept = faults_of_a_warm_cycle();
  long kept_in_thread = -1;
  std::thread([&] {
    prefault_heap(2'000'000);
    const long before = page_faults_of_this_thread();
    void* const block = std::malloc(1'500'000);  // its first use: prefaulted, not warmed up
    touch(block, 1'500'000);
    std::free(block);
    kept_in_thread = page_faults_of_this_thread() - before;
  }).join();
  std::fprintf(stderr, "faults: %ld careless, %ld kept, %ld kept in a thread\n", careless, kept, kept_in_thread);
  std::exit(careless > 50 && kept == 0 && kept_in_thread == 0 ? 0 : 1);
}

TEST_F(MemoryDeathTest, KeptHeapPagesFaultOnce) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  EXPECT_EXIT(compare_heaps(), ExitedWithCode(0), "0 kept, 0 kept in a thread");
}

}  // namespace
}  // namespace cgsr
