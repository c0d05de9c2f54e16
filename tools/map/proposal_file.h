#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "pipeline/mapping/propose.h"
#include "platform/error.h"

namespace cgsr::app {

/// What a file of proposals begins with.
inline constexpr std::string_view kProposalsTitle =
    "# edges that many images show and the map does not hold, by cgsr map refine";

/// Proposals as lines of OBJ, each an object of its own that is numbered from 1, as on the sheet.
std::string proposals_as_obj(std::span<const mapping::Proposal> proposals);

/// The same back, by their numbers: those that a person has left in the file. Ends and images alone are known then.
/// \return what is wrong first, with file, line, value and what was expected: a file that refine did not write, a number that is there twice, a
/// line that is not two ends.
Result<std::map<int, mapping::Proposal>> parse_proposals(std::string_view text, std::string_view name);

/// The same from a file of at most 16 MB.
Result<std::map<int, mapping::Proposal>> read_proposals(const std::filesystem::path& file);

}  // namespace cgsr::app
