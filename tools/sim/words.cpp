#include "tools/sim/words.h"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "hal/sim/scene/scene.h"

namespace cgsr::sim {
namespace {

constexpr double kFarthest_m = 1000.0;
constexpr int kLongestSide_px = 4096;

// Exactly so many finite numbers, or nothing.
template <class Number, std::size_t kCount>
std::optional<std::array<Number, kCount>> numbers(std::string_view text, char separator) {
  std::array<Number, kCount> values{};
  const char* at = text.data();
  const char* end = at + text.size();
  for (std::size_t i = 0; i < kCount; ++i) {
    if (i > 0 && (at == end || *at++ != separator)) return std::nullopt;
    while (at != end && *at == ' ') ++at;
    const auto [next, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc() || !std::isfinite(static_cast<double>(values[i]))) return std::nullopt;
    at = next;
  }
  if (at != end) return std::nullopt;
  return values;
}

Result<void> in_reach(const Eigen::Vector3d& p, const std::string& text) {
  if (p.cwiseAbs().maxCoeff() <= kFarthest_m) return {};
  return fail(fmt::format("'{}' lies more than {} m away; is it in metres?", text, kFarthest_m));
}

}  // namespace

Result<Eigen::Vector3d> parse_point(const std::string& text) {
  const auto n = numbers<double, 3>(text, ',');
  if (!n) return fail(fmt::format("'{}' is not a place: expected X,Y,Z in metres, such as 1.2,3.2,1.5", text));
  const Eigen::Vector3d p((*n)[0], (*n)[1], (*n)[2]);
  if (auto near = in_reach(p, text); !near) return tl::unexpected(near.error());
  return p;
}

Result<Pose> parse_pose(const std::string& text) {
  const auto n = numbers<double, 7>(text, ',');
  if (!n) return fail(fmt::format("'{}' is not a pose: expected tx,ty,tz,qw,qx,qy,qz", text));
  const Eigen::Quaterniond q((*n)[3], (*n)[4], (*n)[5], (*n)[6]);
  if (std::abs(q.norm() - 1.0) > 0.01) {
    return fail(
        fmt::format("'{}' is not a pose: its quaternion qw,qx,qy,qz has the length {:.3g}, not 1", text, q.norm()));
  }
  Pose X = Pose::Identity();
  X.translation() = Eigen::Vector3d((*n)[0], (*n)[1], (*n)[2]);
  if (auto near = in_reach(X.translation(), text); !near) return tl::unexpected(near.error());
  X.linear() = q.normalized().toRotationMatrix();
  return X;
}

Result<Pose> parse_view(const std::string& from, const std::string& to) {
  const auto p = parse_point(from);
  if (!p) return tl::unexpected(p.error());
  const auto q = parse_point(to);
  if (!q) return tl::unexpected(q.error());
  if ((*q - *p).head<2>().norm() < 1e-6) {
    return fail(fmt::format("from {} to {}: straight up or down leaves open which way is up; use --pose", from, to));
  }
  return look_at(*p, *q);
}

Result<ImageSize> parse_image_size(const std::string& text) {
  const auto n = numbers<int, 2>(text, 'x');
  const auto fits = [](int side) { return side >= 16 && side <= kLongestSide_px; };
  if (!n || !fits((*n)[0]) || !fits((*n)[1]) || (*n)[0] % 2 != 0) {
    return fail(fmt::format(
        "'{}' is not a size: expected WIDTHxHEIGHT in pixels, 16 to {} each, the width even, such as 640x480", text,
        kLongestSide_px));
  }
  return ImageSize{(*n)[0], (*n)[1]};
}

}  // namespace cgsr::sim
