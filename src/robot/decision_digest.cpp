#include "src/robot/decision_digest.h"

#include <array>
#include <bit>

#include <Eigen/Geometry>

namespace cgsr::robot {
namespace {

template <class Enum>
std::uint64_t number_of(Enum value) {
  return static_cast<std::uint64_t>(value);
}

}  // namespace

void DecisionDigest::add(config::Sha256& sum, std::uint64_t value) {
  std::array<std::uint8_t, 8> bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  sum.add(bytes.data(), bytes.size());
}

void DecisionDigest::add(config::Sha256& sum, double value) {
  add(sum, std::bit_cast<std::uint64_t>(value));
}

void DecisionDigest::add_image(std::uint64_t image_sequence, const Decision& decision) {
  add(images_, image_sequence);
  const auto& object = decision.object;
  add(images_, number_of(object.found));
  if (object.found) {
    for (const double side : {object.box.x, object.box.y, object.box.width, object.box.height}) add(images_, side);
  }
  add(images_, number_of(decision.where.has_map));
  if (decision.where.has_map) {
    const auto& camera = decision.where.camera;
    add(images_, number_of(camera.state));
    const Eigen::Vector3d p_WC = camera.X_WC.translation();
    const Eigen::Matrix3d R_WC = camera.X_WC.linear();
    for (int i = 0; i < 3; ++i) add(images_, p_WC(i));
    for (int i = 0; i < 9; ++i) add(images_, R_WC(i / 3, i % 3));
  }
  add(images_, number_of(decision.lamp.known));
  if (decision.lamp.known) {
    for (int i = 0; i < 3; ++i) add(images_, decision.lamp.lamp.p_WL(i));
  }
  add(images_, number_of(decision.shade.status));
  add(images_, decision.goal.forward_mps);
  add(images_, decision.goal.left_radps);
  add(images_, number_of(decision.halt));
}

void DecisionDigest::add_request(const SwitchRequest& request) {
  add(requests_, std::uint64_t{request.number});
  add(requests_, number_of(request.line));
  add(requests_, number_of(request.on));
  add(requests_, number_of(request.asked_at.time_since_epoch().count()));
}

std::string DecisionDigest::hex() {
  return config::sha256(images_.hex() + requests_.hex());
}

}  // namespace cgsr::robot
