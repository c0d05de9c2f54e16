#include "tools/map/proposal_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>

#include "src/input/image_input.h"
#include "src/output/overlay.h"

namespace cgsr::app {
namespace {

constexpr double kNearest_m = 0.1;
constexpr double kFarAway_px = 1e5;
constexpr int kPieces = 24;  // of a drawn line, so that it bends as the lens does
constexpr int kColumns = 3;
constexpr int kCellWidth_px = 480;
constexpr int kCaption_px = 28;
const cv::Scalar kProposal(40, 230, 255), kBehind(0, 0, 0), kPaper(255, 255, 255);

cv::Point pixel_of(const Eigen::Vector3d& p_C, const geometry::Camera& camera) {
  const Eigen::Vector2d bent = camera.distorted({p_C.x() / p_C.z(), p_C.y() / p_C.z()});
  const auto rounded = [](double v) { return static_cast<int>(std::lround(std::clamp(v, -kFarAway_px, kFarAway_px))); };
  return {rounded(camera.fx_px * bent.x() + camera.cx_px), rounded(camera.fy_px * bent.y() + camera.cy_px)};
}

/// The images of some views, in one pass over the drive.
Result<std::map<std::int64_t, cv::Mat>> read_images(const std::string& path,
                                                    const std::map<std::int64_t, int>& wanted) {
  auto input = ImageInput::open({.path = path});
  if (!input) return tl::unexpected(input.error());
  std::map<std::int64_t, cv::Mat> images;
  for (std::int64_t frame = 0; images.size() < wanted.size(); ++frame) {
    auto next = input->next();
    if (next.end) return fail(fmt::format("{}: image {} cannot be read again: {}", path, frame, next.problem));
    if (next.image && wanted.contains(frame)) images.emplace(frame, to_bgr(next.image.view()));
  }
  return images;
}

void draw_cell(const mapping::Proposal& proposal, int number, const cv::Mat& image, const mapping::View& view,
               const geometry::Camera& camera, cv::Mat cell) {
  cv::Mat picture = image.clone();
  draw_line(proposal.a, proposal.b, view.X_WC, camera, picture);
  cv::Mat place = cell.rowRange(kCaption_px, cell.rows);
  cv::resize(picture, place, place.size(), 0.0, 0.0, cv::INTER_AREA);
  const std::string words =
      fmt::format("{}: {:.2f} m, in {} images, {:.1f} px off (image {}) {}", number, (proposal.b - proposal.a).norm(),
                  proposal.images, proposal.rms_px, view.number, proposal.part);
  cv::putText(cell, words, {6, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.5, kBehind, 1, cv::LINE_AA);
}

}  // namespace

void draw_line(const Eigen::Vector3d& a_W, const Eigen::Vector3d& b_W, const geometry::Pose& X_WC,
               const geometry::Camera& camera, cv::Mat& picture) {
  const geometry::Pose X_CW = X_WC.inverse();
  const Eigen::Vector3d a = X_CW * a_W, b = X_CW * b_W;
  for (const auto& [color, width] : {std::pair{kBehind, 5}, std::pair{kProposal, 2}}) {
    for (int i = 0; i < kPieces; ++i) {
      const Eigen::Vector3d from = a + (b - a) * (static_cast<double>(i) / kPieces);
      const Eigen::Vector3d to = a + (b - a) * (static_cast<double>(i + 1) / kPieces);
      if (std::min(from.z(), to.z()) < kNearest_m) continue;
      cv::line(picture, pixel_of(from, camera), pixel_of(to, camera), color, width, cv::LINE_AA);
    }
  }
}

Result<cv::Mat> proposal_sheet(std::span<const mapping::Proposal> proposals, std::span<const mapping::View> views,
                               const geometry::Camera& camera, const std::string& input) {
  std::map<std::int64_t, int> wanted;
  for (const mapping::Proposal& proposal : proposals) ++wanted[views[proposal.best_view].number];
  const auto images = read_images(input, wanted);
  if (!images) return tl::unexpected(images.error());
  const int count = static_cast<int>(proposals.size());
  const int height_px = kCaption_px + kCellWidth_px * camera.height_px / camera.width_px;
  const int rows = std::max(1, (count + kColumns - 1) / kColumns);
  cv::Mat sheet(rows * height_px, kColumns * kCellWidth_px, CV_8UC3, kPaper);
  for (int i = 0; i < count; ++i) {
    const mapping::Proposal& proposal = proposals[static_cast<std::size_t>(i)];
    const mapping::View& view = views[proposal.best_view];
    const cv::Rect cell(i % kColumns * kCellWidth_px, i / kColumns * height_px, kCellWidth_px, height_px);
    draw_cell(proposal, i + 1, images->at(view.number), view, camera, sheet(cell));
  }
  return sheet;
}

}  // namespace cgsr::app
