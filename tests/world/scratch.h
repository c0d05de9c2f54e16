#pragma once

#include "tests/support/scratch_folder.h"

namespace cgsr::world {

using test::ScratchFolder;

}  // namespace cgsr::world
