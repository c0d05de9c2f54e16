#pragma once

namespace cgsr::test {

/// The size of the JPEG images that the fuzzer begins with: small, so that many are tried.
inline constexpr int kSeedWidth_px = 32;
inline constexpr int kSeedHeight_px = 16;

}  // namespace cgsr::test
