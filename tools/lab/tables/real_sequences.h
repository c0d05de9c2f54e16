#pragma once

#include <filesystem>

#include "platform/error.h"
#include "tools/lab/experiment.h"

namespace cgsr::lab {

/// Films of others that are followed from one pose (cube, castel, desk), as far as the folder has them: rows of ours and of ViSP's edge tracker, judged
/// by Canny's edges (canny_judge). Ours.
Result<void> add_real_sequences(const Setting& setting, const std::filesystem::path& data, Report& report);

}  // namespace cgsr::lab
