#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace cgsr::test {

/// Where recordings of this name lie below the folder that CGSR_DATA names; empty when they are not there.
inline std::filesystem::path real_data(const std::string& name) {
  const char* const data = std::getenv("CGSR_DATA");
  if (data == nullptr) return {};
  const std::filesystem::path folder = std::filesystem::path(data) / name;
  return std::filesystem::exists(folder) ? folder : std::filesystem::path();
}

/// Whether a test without its recordings fails: CGSR_REQUIRE_DATA=1.
inline bool data_is_required() {
  const char* const require = std::getenv("CGSR_REQUIRE_DATA");
  return require != nullptr && std::string(require) == "1";
}

}  // namespace cgsr::test

/// Ends a test, or its SetUp, that needs real recordings where there are none: skipped, or failed when they are required.
#define CGSR_NEEDS_REAL_DATA(name)                                                                                \
  if (::cgsr::test::real_data(name).empty()) {                                                                    \
    if (::cgsr::test::data_is_required()) FAIL() << "CGSR_REQUIRE_DATA=1: CGSR_DATA does not lead to " << (name); \
    GTEST_SKIP() << "SKIPPED: no data: CGSR_DATA does not lead to " << (name);                                    \
  }                                                                                                               \
  static_assert(true)
