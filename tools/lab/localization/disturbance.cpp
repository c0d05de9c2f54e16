#include "tools/lab/localization/disturbance.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <string>

#include <fmt/format.h>

namespace cgsr::lab {
namespace {

std::string thing_of(const std::string& part) {
  return part.substr(0, part.find('/'));
}

Eigen::Vector3f aside(Random& random) {
  const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
  return Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0).cast<float>();
}

}  // namespace

void scatter(sim::Scene& map, Random random) {
  std::map<std::string, Eigen::Vector3f> moves;
  for (sim::Part& part : map.parts) {
    const auto [at, fresh] = moves.try_emplace(thing_of(part.name), Eigen::Vector3f::Zero());
    if (fresh) at->second = aside(random);
    for (Eigen::Vector3f& p : part.mesh.position_m) p += at->second;
  }
}

void displace(sim::Scene& map, Random random) {
  const Eigen::Vector3f by = aside(random);
  for (sim::Part& part : map.parts) {
    for (Eigen::Vector3f& p : part.mesh.position_m) p += by;
  }
}

void obstruct(sim::WorldSpec& spec, const Standpoint& at, Random random) {
  const double heading = std::atan2(at.X_WC.linear()(1, 2), at.X_WC.linear()(0, 2));
  const bool people = random.chance(0.5);
  const int count = 1 + random.below(people ? 2 : 3);
  for (int i = 0; i < count; ++i) {
    const double away = random.uniform(people ? 0.8 : 1.0, 2.5);
    const double angle = heading + random.uniform(-0.42, 0.42);
    const sim::Triple place{at.X_WC.translation().x() + away * std::cos(angle),
                            at.X_WC.translation().y() + away * std::sin(angle), 0.0};
    const double turned = random.uniform(-180.0, 180.0);
    if (people) {
      sim::PersonSpec person;
      person.name = fmt::format("passer-by {}", i);
      person.identity = random.below(sim::kIdentities);
      person.walk.stop.push_back({.at_m = place, .heading_deg = turned});
      spec.person.push_back(person);
      continue;
    }
    constexpr std::array kFurniture{sim::ShapeKind::kBox, sim::ShapeKind::kTable, sim::ShapeKind::kChair,
                                    sim::ShapeKind::kCabinet, sim::ShapeKind::kBox};
    sim::ShapeSpec shape;
    shape.name = fmt::format("new furniture {}", i);
    shape.kind = kFurniture[static_cast<std::size_t>(random.below(kFurniture.size()))];
    shape.material = spec.material[static_cast<std::size_t>(random.below(static_cast<int>(spec.material.size())))].name;
    shape.second_material = shape.material;
    shape.position_m = place;
    shape.size_m = {random.uniform(0.4, 0.9), random.uniform(0.4, 1.2), random.uniform(0.4, 1.5)};
    shape.heading_deg = turned;
    shape.in_map = false;
    spec.shape.push_back(shape);
  }
}

}  // namespace cgsr::lab
