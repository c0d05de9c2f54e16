#pragma once

#include <string>

#include "pipeline/render/expectation.h"
#include "pipeline/world/map.h"

namespace cgsr::render {

/// Grows whenever Expectation, Map or Camera change: a plug-in of another version is refused.
inline constexpr int kOpenglVersion = 1;

/// What cgsr-opengl.so exports, with C linkage: who draws what should be visible himself loads neither Mesa nor its compiler.
/// Ours; what it makes is the rendering of 4.2.
inline constexpr const char* kOpenglVersionSymbol = "cgsr_opengl_version";  ///< int().
inline constexpr const char* kMakeOpenglSymbol = "cgsr_make_opengl_expectation";
using OpenglVersion = int();

/// \param problem  receives why there is none. \return an OsmesaExpectation as configured by default, or null.
using MakeOpengl = Expectation*(const world::Map* map, std::string* problem);

}  // namespace cgsr::render
