#pragma once

#include <string>

#include "pipeline/color/learn/color_model.h"
#include "platform/error.h"

namespace cgsr::color {

/// Version that save_model writes. load_model reads this one and older ones, and refuses newer ones by name.
inline constexpr int kModelVersion = 1;

/// Writes a model: CBOR {format, version, sha256, payload}, the payload again CBOR. Learn time only, never on the frame path.
/// The file appears whole or not at all: platform/replace_file.h.
/// It holds the histograms that Alg. 3.1 returns, and the samples. The format is ours.
/// \return what could not be written, with the path and the system's reason.
Result<void> save_model(const ColorModel& model, const std::string& path);

/// Reads a model.
/// \return an error that says what is wrong with which file: missing, not a model, newer than this program, damaged (checksum),
///         truncated, larger than any model, sizes that do not fit, numbers that are not finite.
Result<ColorModel> load_model(const std::string& path);

}  // namespace cgsr::color
