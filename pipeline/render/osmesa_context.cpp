#include "pipeline/render/osmesa_context.h"

#include <array>
#include <cstdlib>
#include <vector>

#include <GL/osmesa.h>

namespace cgsr::render {
namespace {

class Context : public OsmesaContext {
 public:
  Context(OSMesaContext context, int width, int height)
      : context_(context),
        width_(width),
        height_(height),
        pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
  ~Context() override { OSMesaDestroyContext(context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  bool make_current() override {
    if (OSMesaMakeCurrent(context_, pixels_.data(), GL_UNSIGNED_BYTE, width_, height_) == GL_FALSE) return false;
    OSMesaPixelStore(OSMESA_Y_UP, 0);
    return true;
  }

  void release() override { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

  [[nodiscard]] std::span<const std::uint32_t> pixels() const override { return pixels_; }

  [[nodiscard]] std::span<const std::uint32_t> depths() const override {
    GLint width = 0;
    GLint height = 0;
    GLint bytes = 0;
    void* buffer = nullptr;
    if (OSMesaGetDepthBuffer(context_, &width, &height, &bytes, &buffer) == GL_FALSE) return {};
    if (width != width_ || height != height_ || bytes != 4) return {};
    return {static_cast<const std::uint32_t*>(buffer), pixels_.size()};
  }

 private:
  OSMesaContext context_;
  int width_;
  int height_;
  std::vector<std::uint32_t> pixels_;
};

}  // namespace

std::unique_ptr<OsmesaContext> OsmesaContext::make(int width, int height) {
  // Mesa reads them when its first context is made. softpipe, its other renderer, takes ten times as long.
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LP_NUM_THREADS", "0", 1);
  setenv("LP_NATIVE_VECTOR_WIDTH", "128", 1);
  const std::array<int, 11> wanted = {OSMESA_FORMAT,
                                      OSMESA_RGBA,
                                      OSMESA_DEPTH_BITS,
                                      24,
                                      OSMESA_STENCIL_BITS,
                                      8,
                                      OSMESA_PROFILE,
                                      OSMESA_COMPAT_PROFILE,
                                      0,
                                      0,
                                      0};
  OSMesaContext made = OSMesaCreateContextAttribs(wanted.data(), nullptr);
  if (made == nullptr) return nullptr;
  auto context = std::make_unique<Context>(made, width, height);
  if (!context->make_current()) return nullptr;
  return context;
}

}  // namespace cgsr::render
