#include "tools/lab/film.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tools/lab/scenes/moving_scene.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 2> kImageFolders{"img", "images"};
constexpr std::array<std::string_view, 2> kTruthFiles{"groundtruth.txt", "groundtruth_rect.txt"};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!entry.path().filename().string().starts_with('.')) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// \return the first of these names that is there; the first name where none is.
fs::path one_of(const fs::path& folder, std::span<const std::string_view> names) {
  for (const std::string_view name : names) {
    if (fs::exists(folder / name)) return folder / name;
  }
  return folder / names.front();
}

Image scaled_image(const Image& image, const cv::Size& size) {
  cv::Mat scaled;
  cv::resize(image.bgr, scaled, size, 0, 0, size.area() < image.bgr.size().area() ? cv::INTER_AREA : cv::INTER_LINEAR);
  return image_of_bgr(scaled);
}

}  // namespace

Result<Film> open_film(const std::filesystem::path& folder, std::optional<cv::Size> size) {
  const fs::path images = one_of(folder, kImageFolders);
  const fs::path truth_file = one_of(folder, kTruthFiles);
  const auto files = files_in(images);
  if (files.empty()) return fail(fmt::format("there are no images in {}", images.string()));
  auto truth = read_truth(truth_file);
  if (!truth) return tl::unexpected(truth.error());
  if (auto checked = app::check_length(truth_file, *truth, files.size()); !checked) {
    return tl::unexpected(checked.error());
  }
  truth->resize(files.size());
  if (!truth->front()) {
    return fail(fmt::format("{}: the object is not visible in the first image, so there is nothing to learn from",
                            truth_file.string()));
  }
  const auto first = load_image(files.front());
  if (!first) return tl::unexpected(first.error());
  const cv::Size recorded = first->bgr.size();
  const cv::Size wanted = size.value_or(recorded);
  const double sx = static_cast<double>(wanted.width) / recorded.width,
               sy = static_cast<double>(wanted.height) / recorded.height;
  for (auto& box : *truth) {
    if (box) box = Box{box->x * sx, box->y * sy, box->width * sx, box->height * sy};
  }
  const auto load = [files, wanted](int i) {
    auto image = load_image(files[static_cast<std::size_t>(i)]);
    if (image && image->bgr.size() != wanted) image = scaled_image(*image, wanted);
    return image;
  };
  return Film{folder.filename().string(), load, std::move(*truth)};
}

Film generated_film(std::uint64_t seed, int images, bool absent) {
  const auto scene = std::make_shared<const MovingScene>(seed, images, absent);
  return {fmt::format("generated-{}{}", seed, absent ? "-absent" : ""),
          [scene](int i) -> Result<Image> { return scene->image(i); }, scene->truth()};
}

Result<void> save_film(const Film& film, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder / "img", error);
  std::ofstream truth(folder / "groundtruth.txt");
  for (int i = 0; i < film.size(); ++i) {
    const auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    const auto file = folder / "img" / fmt::format("{:04}.png", i);
    if (!cv::imwrite(file.string(), image->bgr)) return fail(fmt::format("cannot write {}", file.string()));
    const auto& box = film.truth[static_cast<std::size_t>(i)];
    if (box) {
      fmt::print(truth, "{:.3f},{:.3f},{:.3f},{:.3f}\n", box->x, box->y, box->width, box->height);
    } else {
      fmt::print(truth, "nan,nan,nan,nan\n");
    }
  }
  if (!truth.flush()) return fail(fmt::format("cannot write {}", (folder / "groundtruth.txt").string()));
  return {};
}

}  // namespace cgsr::lab
