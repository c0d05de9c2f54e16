#include "tools/sim/truth_pictures.h"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace cgsr::sim {
namespace {

cv::Mat depth_mm(const GeometryImage& geometry) {
  cv::Mat picture(geometry.height_px, geometry.width_px, CV_16U);
  for (int i = 0; i < picture.rows * picture.cols; ++i) {
    picture.at<std::uint16_t>(i / picture.cols, i % picture.cols) =
        cv::saturate_cast<std::uint16_t>(1000.0F * geometry.depth_m[static_cast<std::size_t>(i)]);
  }
  return picture;
}

cv::Mat part_numbers(const GeometryImage& geometry) {
  cv::Mat picture(geometry.height_px, geometry.width_px, CV_16U);
  for (int i = 0; i < picture.rows * picture.cols; ++i) {
    picture.at<std::uint16_t>(i / picture.cols, i % picture.cols) =
        cv::saturate_cast<std::uint16_t>(geometry.part[static_cast<std::size_t>(i)] + 1);
  }
  return picture;
}

std::string part_names(const Scene& scene) {
  std::string text = "number,name,actor\n";
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const Part& part = scene.parts[i];
    const std::string actor = part.figure < 0 ? "" : scene.figures[static_cast<std::size_t>(part.figure)].name;
    text += fmt::format("{},\"{}\",\"{}\"\n", i + 1, part.name, actor);
  }
  return text;
}

cv::Mat mask(const ShadowMasks& masks, const std::vector<std::uint8_t>& bytes) {
  cv::Mat picture(masks.height_px, masks.width_px, CV_8U);
  std::memcpy(picture.data, bytes.data(), bytes.size());
  return picture;
}

}  // namespace

Result<void> check_picture_path(const std::filesystem::path& path) {
  if (path.extension() != ".png") return fail(fmt::format("{}: pictures are written as .png", path.string()));
  std::error_code error;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, error))
    return fail(fmt::format("{}: there is no such folder", folder.string()));
  return {};
}

Result<void> write_picture(const std::filesystem::path& path, const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes);
  return write_text(path, std::string(bytes.begin(), bytes.end()));
}

Result<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) return fail(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  return {};
}

cv::Mat as_bgr(const cv::Mat& yuyv) {
  cv::Mat bgr;
  cv::cvtColor(yuyv, bgr, cv::COLOR_YUV2BGR_YUYV);
  return bgr;
}

Result<void> write_truth_pictures(const Renderer& renderer, const Truth& truth, const TruthOptions& options,
                                  const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail(fmt::format("{}: {}", folder.string(), error.message()));
  const Scene& scene = renderer.scene();
  auto written = write_text(folder / "truth.csv", truth_csv_header(scene, options) + truth_csv_row(0, truth));
  if (written) written = write_picture(folder / "depth.png", depth_mm(renderer.geometry()));
  if (written) written = write_picture(folder / "parts.png", part_numbers(renderer.geometry()));
  if (written) written = write_text(folder / "parts.csv", part_names(scene));
  if (!written || !truth.masks) return written;
  written = write_picture(folder / "surface_shaded.png", mask(*truth.masks, truth.masks->surface_shaded));
  return written ? write_picture(folder / "possibly_shaded.png", mask(*truth.masks, truth.masks->possibly_shaded))
                 : written;
}

}  // namespace cgsr::sim
