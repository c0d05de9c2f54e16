#include "tools/lab/localization/real_pictures.h"

#include <algorithm>
#include <fstream>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include "pipeline/render/depth_raster.h"
#include "src/output/map_overlay.h"
#include "src/output/video_writer.h"

namespace cgsr::lab {
namespace {

constexpr double kPoseFilm_hz = 10.0;

}  // namespace

namespace fs = std::filesystem;

std::vector<double> numbers_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<double> numbers;
  for (double number = 0.0; file >> number;) numbers.push_back(number);
  return numbers;
}

std::vector<fs::path> pictures_of(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) paths.push_back(entry.path());
  std::ranges::sort(paths);
  return paths;
}

std::string VispChoice::name() const {
  return fmt::format("ViSP, range {} px, {} call{}", range_px, calls, calls == 1 ? "" : "s");
}

Result<fs::path> film_of_poses(const Setting& setting, const std::string& name, const world::Map& map,
                               const geometry::Camera& camera, const std::vector<fs::path>& pictures,
                               const std::vector<std::optional<geometry::Pose>>& found, const std::string& who) {
  const fs::path folder = setting.videos.value_or(fs::temp_directory_path() / "cgsr-videos");
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const fs::path path = folder / (name + ".mkv");
  render::DepthRaster expectation(map, render::RasterParameters{});
  app::MapOverlay overlay(map, expectation, camera);
  auto video = app::VideoWriter::create(path.string(), overlay.picture_size(), kPoseFilm_hz);
  if (!video) return tl::unexpected(video.error());
  std::optional<geometry::Pose> last;
  for (std::size_t i = 0; i < std::min(pictures.size(), found.size()); ++i) {
    const cv::Mat grey = cv::imread(pictures[i].string(), cv::IMREAD_GRAYSCALE);
    if (found[i]) last = found[i];
    if (!last) continue;
    const ImageView view{grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
    const std::string words = fmt::format("{}, image {}{}", who, i, found[i] ? "" : ": no pose");
    if (auto added = video->add(overlay.draw(view, *last, found[i].has_value(), words)); !added) {
      return tl::unexpected(added.error());
    }
  }
  if (auto closed = video->close(); !closed) return tl::unexpected(closed.error());
  return path;
}

}  // namespace cgsr::lab
