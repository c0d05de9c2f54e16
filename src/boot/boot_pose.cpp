#include "src/boot/boot_pose.h"

#include <cmath>
#include <numbers>

#include <fmt/core.h>

#include "platform/replace_file.h"
#include "src/input/pose_file.h"
#include "src/input/small_file.h"
#include "src/output/overlay.h"
#include "src/output/text_file.h"

namespace cgsr::boot {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kMaxPoseText_bytes = 64U << 20U;  // as boot_pose() reads

localization::Prior prior_on_floor(const geometry::Pose& X_WC, double sigma_m, double sigma_rad) {
  auto sigmas = localization::PriorSigmas::floor();
  sigmas.x_m = sigmas.y_m = sigma_m;
  sigmas.heading_rad = sigma_rad;
  return localization::prior_at(X_WC, sigmas);
}

}  // namespace

Result<BootPose> boot_pose(const config::StartPose& start, const geometry::Camera& camera, const geometry::Pose& X_RC,
                           const ImageView& first_image) {
  BootPose boot;
  std::error_code error;
  if (!start.file.empty() && std::filesystem::exists(start.file, error)) {
    const auto X_WR = app::read_pose(start.file);
    if (!X_WR) return tl::unexpected(X_WR.error());
    boot.prior = prior_on_floor(*X_WR * X_RC, start.sigma_m, start.sigma_deg * kDegree);
    boot.message = fmt::format("the last run's pose ({})", start.file);
    return boot;
  }
  const bool look_for_marker = start.marker.id >= 0 && !first_image.empty();
  const auto X_WC =
      look_for_marker ? calibration::camera_by_marker(start.marker, camera, app::to_bgr(first_image)) : std::nullopt;
  if (X_WC) {
    boot.prior = prior_on_floor(*X_WC, start.sigma_m, start.sigma_deg * kDegree);
    boot.message = fmt::format("marker {}", start.marker.id);
    return boot;
  }
  if (start.anywhere) {
    boot.anywhere = true;
    boot.message = "its first turn on the spot";
    return boot;
  }
  const geometry::Pose X_WR = geometry::pose_on_floor(start.x_m, start.y_m, start.heading_deg * kDegree);
  boot.prior = prior_on_floor(X_WR * X_RC, start.sigma_m, start.sigma_deg * kDegree);
  boot.message = "the robot's file";
  return boot;
}

Result<std::string> withdraw_pose(const std::filesystem::path& file) {
  Result<std::string> text;
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) {
    text = app::read_small_file(file, kMaxPoseText_bytes, "a file of poses");
    if (!text) return text;
  }
  if (auto removed = remove_file(file); !removed) return tl::unexpected(removed.error());
  return text;
}

Result<void> put_back_pose(const std::filesystem::path& file, const std::string& text) {
  return app::write_file(file, text);
}

Result<void> leave_pose(const std::filesystem::path& file, const geometry::Pose& X_WR) {
  return app::write_file(file, fmt::format("{}\n{}\n", app::kPoseColumns, app::pose_as_csv(X_WR)));
}

}  // namespace cgsr::boot
