#pragma once

#include <cstdint>

#include "platform/error.h"

namespace cgsr::lab {

/// Searches for the first poses of table-4.1 from priors of the stated width, each call of the localizer an image between the marks of tools/count:
/// the stage `correct`.
Result<void> search_for_poses(std::uint64_t seed, int poses);

}  // namespace cgsr::lab
