#pragma once

#include <string>
#include <string_view>

namespace cgsr::world {

/// Ours. Compares the lengths that a binary glTF file claims with what it has, before anything is allocated by them.
/// (glTF 2.0 specification, section 4.4: 12 bytes of header, then chunks of length, type and data.)
/// \return what is wrong; empty when the header and all chunks lie within the file, or when it is no binary glTF 2 (others refuse that).
std::string glb_problem(std::string_view file);

}  // namespace cgsr::world
