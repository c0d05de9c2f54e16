// Large values that are handed on without copies.
#include "platform/pool.h"

#include <thread>

#include <gtest/gtest.h>

namespace cgsr {
namespace {

TEST(Pool, LendsEachValueToOneWriterAndTakesItBackFromTheLastReader) {
  Pool<int> pool(2, 0);
  Lease<int> first = pool.take();
  ASSERT_TRUE(first);
  first.edit() = 1;
  Lease<int> second = pool.take();
  ASSERT_TRUE(second);
  EXPECT_NE(first.get(), second.get());
  EXPECT_FALSE(pool.take()) << "both are read";
  Lease<int> copy = first;
  first = {};
  EXPECT_FALSE(pool.take()) << "a copy still reads it";
  EXPECT_EQ(*copy, 1);
  copy = {};
  EXPECT_TRUE(pool.take());
}

TEST(Pool, ALeaseMayOutliveItsPool) {
  Lease<std::string> kept;
  {
    Pool<std::string> pool(1, "what was lent");
    kept = pool.take();
  }
  EXPECT_EQ(*kept, "what was lent");
}

// The thread sanitizer watches: a value is never written while the other thread reads it.
TEST(PoolStress, AReaderNeverSeesTheNextWriting) {
  struct Pair {
    int a = 0;
    int b = 0;
  };
  Pool<Pair> pool(3, {});
  std::atomic<int> wrong{0};
  std::vector<Lease<Pair>> handed(1);
  for (int i = 1; i < 2000; ++i) {
    Lease<Pair> lease = pool.take();
    ASSERT_TRUE(lease);
    lease.edit() = {i, i};
    std::thread reader([lease = std::move(lease), &wrong, i] { wrong += lease->a == i && lease->b == i ? 0 : 1; });
    reader.join();
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace cgsr
