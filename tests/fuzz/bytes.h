#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace cgsr::test {

/// The bytes that a fuzzer hands over, taken as numbers from the front; zeros once they have come to their end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  [[nodiscard]] bool empty() const { return left_.empty(); }

  std::uint8_t byte() {
    if (left_.empty()) return 0;
    const std::uint8_t first = left_.front();
    left_ = left_.subspan(1);
    return first;
  }

  /// A whole number of [least, most], of which there are at most 256.
  int whole(int least, int most) { return least + byte() % (most - least + 1); }

 private:
  std::span<const std::uint8_t> left_;
};

}  // namespace cgsr::test
