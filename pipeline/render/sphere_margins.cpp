#include "pipeline/render/sphere_margins.h"

namespace cgsr::render {

void margins_in(const Frustum& frustum, const float* __restrict x, const float* __restrict y, const float* __restrict z,
                std::size_t count, float* __restrict out) {
  float nx[5];
  float ny[5];
  float nz[5];
  float o[5];
  for (std::size_t k = 0; k < 5; ++k) {
    nx[k] = frustum.normal[k].x();
    ny[k] = frustum.normal[k].y();
    nz[k] = frustum.normal[k].z();
    o[k] = frustum.offset[k];
  }
  for (std::size_t i = 0; i < count; ++i) {
    float least = nx[0] * x[i] + ny[0] * y[i] + nz[0] * z[i] + o[0];
    const float right = nx[1] * x[i] + ny[1] * y[i] + nz[1] * z[i] + o[1];
    least = right < least ? right : least;
    const float top = nx[2] * x[i] + ny[2] * y[i] + nz[2] * z[i] + o[2];
    least = top < least ? top : least;
    const float bottom = nx[3] * x[i] + ny[3] * y[i] + nz[3] * z[i] + o[3];
    least = bottom < least ? bottom : least;
    const float near = nx[4] * x[i] + ny[4] * y[i] + nz[4] * z[i] + o[4];
    out[i] = near < least ? near : least;
  }
}

}  // namespace cgsr::render
