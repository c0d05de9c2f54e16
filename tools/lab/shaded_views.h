#pragma once

#include <cstdint>

#include "platform/error.h"

namespace cgsr::lab {

/// Looks for shaded regions in the home's map from `views` standpoints under one lamp, each twice, between the marks of tools/count: the stages
/// `new_view`, `nothing_moved` and, once, `lamp`.
Result<void> look_at_shade(std::uint64_t seed, int views);

}  // namespace cgsr::lab
