#pragma once

#include <array>
#include <cstdint>

#include "hal/sim/render/tracer.h"

namespace cgsr::sim {

/// Places that ask for one lamp, up to eight.
struct ShadowQuery {
  std::array<bool, kPacket> wanted{};
  std::array<Eigen::Vector3f, kPacket> from;
  std::array<std::uint32_t, kPacket> seed{};
};

/// The share of a lamp's disc that each wanted place sees: 0 or 1 for a point. For a ball of `radius_m`, 4 points on its rim, turned
/// differently for every place, tell whether the whole bundle is in full light or full shadow; if they do not all agree, 16 samples for
/// each place tell how much.
std::array<float, kPacket> visible_share(const Tracer& tracer, const ShadowQuery& query, const Eigen::Vector3f& p_WL,
                                         float radius_m, bool coherent);

/// Is the centre of the lamp hidden, seen by rays of this kind?
std::array<bool, kPacket> centre_hidden(const Tracer& tracer, const ShadowQuery& query, const Eigen::Vector3f& p_WL,
                                        unsigned kind);

}  // namespace cgsr::sim
