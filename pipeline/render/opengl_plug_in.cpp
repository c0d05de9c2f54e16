#include "pipeline/render/opengl_plug_in.h"

#include <exception>

#include "pipeline/render/osmesa_expectation.h"

using cgsr::render::Expectation;

extern "C" __attribute__((visibility("default"))) int cgsr_opengl_version() {
  return cgsr::render::kOpenglVersion;
}

// No exception may cross into the program.
extern "C" __attribute__((visibility("default"))) Expectation* cgsr_make_opengl_expectation(const cgsr::world::Map* map,
                                                                                            std::string* problem) try {
  auto made = cgsr::render::OsmesaExpectation::make(*map, {});
  if (made) return made->release();
  *problem = made.error().message;
  return nullptr;
} catch (const std::exception& caught) {
  *problem = std::string("OpenGL failed: ") + caught.what();
  return nullptr;
}
