#pragma once

#include <cstdint>

#include "platform/error.h"

namespace cgsr::lab {

/// Runs the stage shade in the home's map from `views` standpoints under one lamp, each twice, between the marks of tools/count: `new_view`,
/// `nothing_moved` and, for the turns that work on the lamp's place, `new_lamp`.
Result<void> look_at_shade(std::uint64_t seed, int views);

}  // namespace cgsr::lab
