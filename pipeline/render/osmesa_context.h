#pragma once

#include <cstdint>
#include <memory>
#include <span>

namespace cgsr::render {

/// OpenGL (2.4) without a window: a context of OSMesa that draws into memory of its own. The only place that knows how Mesa is set up: llvmpipe,
/// without threads of its own, with vectors of SSE's width, so that it draws alike on every machine.
///
/// OpenGL's state belongs to the thread: make_current() before anything is drawn.
class OsmesaContext {
 public:
  /// \return nothing when Mesa cannot make one.
  static std::unique_ptr<OsmesaContext> make(int width, int height);

  virtual ~OsmesaContext() = default;
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

  /// \return whether it could.
  virtual bool make_current() = 0;

  /// Leaves the thread, for another to draw.
  virtual void release() = 0;

  /// What was drawn, four bytes a pixel as R | G << 8 | B << 16 | A << 24, the top row first; whole after glFinish(). Never copied.
  [[nodiscard]] virtual std::span<const std::uint32_t> pixels() const = 0;

  /// The depth buffer likewise, 24 bits of depth in the lower three bytes of each pixel, 0 at the near plane; the bottom row
  /// first. Empty where Mesa does not show it.
  [[nodiscard]] virtual std::span<const std::uint32_t> depths() const = 0;

 protected:
  OsmesaContext() = default;
};

}  // namespace cgsr::render
