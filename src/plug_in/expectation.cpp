#include "src/plug_in/expectation.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "pipeline/render/opengl_plug_in.h"
#include "src/plug_in/library.h"

namespace cgsr {

Result<std::unique_ptr<render::Expectation>> make_expectation(const world::Map& map,
                                                              const localization::LocalizerParameters& parameters) {
  if (parameters.expectation == localization::ExpectationKind::kRaster) return nullptr;
  const auto path = PlugInLibrary::beside_program("cgsr-opengl.so");
  if (!path) return tl::unexpected(path.error());
  const auto library = PlugInLibrary::open(*path);
  if (!library) {
    return fail(fmt::format("localizer.expectation = \"osmesa\" cannot be loaded: {}", library.error().message));
  }
  auto* const version = library->function<render::OpenglVersion>(render::kOpenglVersionSymbol);
  auto* const make = library->function<render::MakeOpengl>(render::kMakeOpenglSymbol);
  if (version == nullptr || make == nullptr || version() != render::kOpenglVersion) {
    return fail(fmt::format("{}: is not of this program's version: build both together", *path));
  }
  std::string problem;
  std::unique_ptr<render::Expectation> expectation(make(&map, &problem));
  if (!expectation) return fail(std::move(problem));
  return expectation;
}

}  // namespace cgsr
