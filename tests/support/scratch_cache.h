#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "tests/support/scratch_folder.h"

namespace cgsr::test {

/// The user's cache is a folder of the test's own while this lives: rendered images that are kept do not outlive the test.
class ScratchCache {
 public:
  ScratchCache() {
    if (const char* before = std::getenv(kName); before != nullptr) before_ = before;
    setenv(kName, (folder_ / "cache").c_str(), 1);
  }
  ~ScratchCache() { before_ ? setenv(kName, before_->c_str(), 1) : unsetenv(kName); }
  ScratchCache(const ScratchCache&) = delete;
  ScratchCache& operator=(const ScratchCache&) = delete;

  [[nodiscard]] std::string path() const { return folder_ / "cache"; }

 private:
  static constexpr const char* kName = "XDG_CACHE_HOME";
  ScratchFolder folder_;
  std::optional<std::string> before_;
};

}  // namespace cgsr::test
