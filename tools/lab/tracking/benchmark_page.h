#pragma once

#include <filesystem>
#include <vector>

#include "platform/error.h"
#include "tools/lab/report.h"
#include "tools/lab/tracking/sequence_film.h"

namespace cgsr::lab {

/// Writes FOLDER/index.html: the report with its curves, and below it the film and the failures of each sequence, which lie in the folder.
/// \return which file cannot be written.
Result<void> write_benchmark_page(const Report& report, const std::vector<SequencePictures>& sequences,
                                  const std::filesystem::path& folder);

}  // namespace cgsr::lab
