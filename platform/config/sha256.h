#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace cgsr::config {

/// SHA-256 (FIPS 180-4) by OpenSSL, in pieces.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;

  void add(const void* bytes, std::size_t count);

  /// \return 64 lower-case hexadecimal digits. Ends the sum: nothing may be added afterwards.
  std::string hex();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

std::string sha256(std::string_view bytes);

}  // namespace cgsr::config
