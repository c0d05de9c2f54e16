#pragma once

#include <filesystem>
#include <string>

#include "pipeline/person/identities.h"
#include "platform/error.h"

namespace cgsr::app {

/// Version that save_identities writes. load_identities refuses newer ones by name.
inline constexpr int kIdentitiesVersion = 1;

/// Writes the identities: CBOR {format, version, sha256, payload}, the payload again CBOR; readable by the owner alone (mode 0600). The file appears
/// whole or not at all: it is written beside its place, synchronised and renamed.
Result<void> save_identities(const person::Identities& identities, const std::filesystem::path& path);

/// \return the identities; none where there is no such file; or what is wrong with it: not such a file, newer than this program, damaged.
Result<person::Identities> load_identities(const std::filesystem::path& path);

/// The same for who is about to write the file: a damaged one is kept aside under another name, never overwritten.
struct OpenedIdentities {
  person::Identities identities;
  std::string note;  ///< where a damaged file was put, and why; empty: it was sound.
};
Result<OpenedIdentities> open_identities(const std::filesystem::path& path);

}  // namespace cgsr::app
