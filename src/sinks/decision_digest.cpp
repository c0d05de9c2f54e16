#include "src/sinks/decision_digest.h"

#include <array>
#include <bit>

#include <Eigen/Geometry>

namespace cgsr::sinks {
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

void DecisionDigest::add_image(std::uint64_t image_sequence, const stages::FrameResult& frame) {
  add(images_, image_sequence);
  const auto& object = frame.objects.value.first().object;
  add(images_, number_of(object.found));
  if (object.found) {
    for (const double side : {object.box.x, object.box.y, object.box.width, object.box.height}) add(images_, side);
  }
  const stages::PoseEstimate& pose = frame.pose.value;
  add(images_, number_of(pose.has_map));
  if (pose.has_map) {
    add(images_, number_of(pose.camera.state));
    const Eigen::Vector3d p_WC = pose.camera.X_WC.translation();
    const Eigen::Matrix3d R_WC = pose.camera.X_WC.linear();
    for (int i = 0; i < 3; ++i) add(images_, p_WC(i));
    for (int i = 0; i < 9; ++i) add(images_, R_WC(i / 3, i % 3));
  }
  const stages::LampReport& lamp = frame.lamp.value;
  add(images_, number_of(lamp.known));
  if (lamp.known) {
    for (int i = 0; i < 3; ++i) add(images_, lamp.lamp.p_WL(i));
  }
  add(images_, number_of(frame.shade.value.status));
  const stages::Decision& decision = frame.decision.value;
  add(images_, decision.goal.forward_mps);
  add(images_, decision.goal.left_radps);
  add(images_, number_of(decision.halt));
}

void DecisionDigest::add_request(const stages::SwitchRequest& request) {
  add(requests_, std::uint64_t{request.number});
  add(requests_, number_of(request.line));
  add(requests_, number_of(request.on));
  add(requests_, number_of(request.asked_at.time_since_epoch().count()));
}

std::string DecisionDigest::hex() {
  return config::sha256(images_.hex() + requests_.hex());
}

}  // namespace cgsr::sinks
