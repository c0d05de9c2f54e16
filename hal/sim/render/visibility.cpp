#include "hal/sim/render/visibility.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

// Points that cover a disc evenly: the golden-angle spiral.
template <int kCount>
std::array<Vector2f, kCount> disc_points() {
  std::array<Vector2f, kCount> points;
  for (int i = 0; i < kCount; ++i) {
    const double r = std::sqrt((i + 0.5) / kCount);
    const double a = 2.399963229728653 * i;
    points[static_cast<std::size_t>(i)] = Eigen::Vector2d(r * cosine(a), r * sine(a)).cast<float>();
  }
  return points;
}

constexpr float kRimRadius = 0.98F;
const std::array<Vector2f, 4> kRim{Vector2f(kRimRadius, 0.0F), Vector2f(0.0F, kRimRadius), Vector2f(-kRimRadius, 0.0F),
                                   Vector2f(0.0F, -kRimRadius)};
const std::array<Vector2f, 16> kSixteen = disc_points<16>();
const std::array<Vector2f, 256> kTurns = [] {
  std::array<Vector2f, 256> turns;
  for (int i = 0; i < 256; ++i) {
    turns[static_cast<std::size_t>(i)] =
        Eigen::Vector2d(cosine(2.0 * kPi * i / 256), sine(2.0 * kPi * i / 256)).cast<float>();
  }
  return turns;
}();

struct alignas(32) ShadowPacket {
  alignas(32) int valid[kPacket] = {};
  RTCRay8 rays{};

  void aim(int lane, const Vector3f& from, const Vector3f& to, unsigned kind) {
    valid[lane] = -1;
    rays.org_x[lane] = from.x();
    rays.org_y[lane] = from.y();
    rays.org_z[lane] = from.z();
    rays.dir_x[lane] = to.x() - from.x();
    rays.dir_y[lane] = to.y() - from.y();
    rays.dir_z[lane] = to.z() - from.z();
    rays.tnear[lane] = 0.0F;
    rays.tfar[lane] = 1.0F;
    rays.mask[lane] = kind;
  }
  [[nodiscard]] bool hit(int lane) const { return rays.tfar[lane] < 0.0F; }
};

// The disc that a ball shows to a place: its plane's axes, scaled by the radius, turned by the seed.
struct Disc {
  Disc(const Vector3f& from, const Vector3f& centre, float radius, std::uint32_t seed) : centre_(centre) {
    const Vector3f towards = (centre - from).normalized();
    const Vector3f x = towards.unitOrthogonal();
    const Vector3f y = towards.cross(x);
    const Vector2f& turn = kTurns[seed & 255U];
    x_ = radius * (turn.x() * x + turn.y() * y);
    y_ = radius * (turn.x() * y - turn.y() * x);
  }
  [[nodiscard]] Vector3f at(const Vector2f& p) const { return centre_ + p.x() * x_ + p.y() * y_; }

 private:
  Vector3f centre_;
  Vector3f x_;
  Vector3f y_;
};

int sixteen(const Tracer& tracer, const Vector3f& from, const Disc& disc) {
  int seen = 0;
  for (int first = 0; first < 16; first += kPacket) {
    ShadowPacket packet;
    for (int lane = 0; lane < kPacket; ++lane) {
      packet.aim(lane, from, disc.at(kSixteen[static_cast<std::size_t>(first + lane)]), kShadowRays);
    }
    tracer.blocked(packet.valid, packet.rays, true);
    for (int lane = 0; lane < kPacket; ++lane) seen += packet.hit(lane) ? 0 : 1;
  }
  return seen;
}

}  // namespace

std::array<bool, kPacket> centre_hidden(const Tracer& tracer, const ShadowQuery& query, const Vector3f& p_WL,
                                        unsigned kind) {
  ShadowPacket packet;
  for (int lane = 0; lane < kPacket; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    if (query.wanted[i]) packet.aim(lane, query.from[i], p_WL, kind);
  }
  tracer.blocked(packet.valid, packet.rays, true);
  std::array<bool, kPacket> hidden{};
  for (int lane = 0; lane < kPacket; ++lane) {
    const auto i = static_cast<std::size_t>(lane);
    hidden[i] = query.wanted[i] && packet.hit(lane);
  }
  return hidden;
}

std::array<float, kPacket> visible_share(const Tracer& tracer, const ShadowQuery& query, const Vector3f& p_WL,
                                         float radius_m, bool coherent) {
  std::array<float, kPacket> share{};
  if (radius_m <= 0.0F) {
    const auto hidden = centre_hidden(tracer, query, p_WL, kShadowRays);
    for (std::size_t i = 0; i < kPacket; ++i) share[i] = query.wanted[i] && !hidden[i] ? 1.0F : 0.0F;
    return share;
  }
  std::array<int, kPacket> seen{};
  for (const Vector2f& point : kRim) {
    ShadowPacket packet;
    for (int lane = 0; lane < kPacket; ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      if (query.wanted[i]) {
        packet.aim(lane, query.from[i], Disc(query.from[i], p_WL, radius_m, query.seed[i]).at(point), kShadowRays);
      }
    }
    tracer.blocked(packet.valid, packet.rays, coherent);
    for (int lane = 0; lane < kPacket; ++lane) seen[static_cast<std::size_t>(lane)] += packet.hit(lane) ? 0 : 1;
  }
  int least = 4;
  int most = 0;
  for (std::size_t i = 0; i < kPacket; ++i) {
    if (!query.wanted[i]) continue;
    least = std::min(least, seen[i]);
    most = std::max(most, seen[i]);
  }
  const bool agreed = least == most && (most == 0 || most == 4);
  for (std::size_t i = 0; i < kPacket; ++i) {
    if (!query.wanted[i]) continue;
    if (agreed) {
      share[i] = most == 0 ? 0.0F : 1.0F;
    } else {
      const Disc disc(query.from[i], p_WL, radius_m, query.seed[i]);
      share[i] = static_cast<float>(sixteen(tracer, query.from[i], disc)) / 16.0F;
    }
  }
  return share;
}

}  // namespace cgsr::sim
