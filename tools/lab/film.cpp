#include "tools/lab/film.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "tools/lab/scenes/moving_scene.h"

namespace cgsr::lab {
namespace {

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (!entry.path().filename().string().starts_with('.')) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

Image scaled_image(const Image& image, const cv::Size& size) {
  cv::Mat scaled;
  cv::resize(image.bgr, scaled, size, 0, 0, size.area() < image.bgr.size().area() ? cv::INTER_AREA : cv::INTER_LINEAR);
  return image_of_bgr(scaled);
}

}  // namespace

Result<Film> open_film(const std::filesystem::path& folder, std::optional<cv::Size> size) {
  const auto files = files_in(folder / "img");
  if (files.empty()) return fail(fmt::format("there are no images in {}", (folder / "img").string()));
  auto truth = read_truth(folder / "groundtruth.txt");
  if (!truth) return tl::unexpected(truth.error());
  if (auto checked = app::check_length(folder / "groundtruth.txt", *truth, files.size()); !checked) {
    return tl::unexpected(checked.error());
  }
  truth->resize(files.size());
  if (!truth->front()) {
    return fail(fmt::format("{}: the object is not visible in the first image, so there is nothing to learn from",
                            (folder / "groundtruth.txt").string()));
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
