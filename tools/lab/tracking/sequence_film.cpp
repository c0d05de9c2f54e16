#include "tools/lab/tracking/sequence_film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "src/output/video_writer.h"

namespace cgsr::lab {
namespace {

constexpr double kRate_hz = 25.0;
constexpr int kMostFailures = 8;
constexpr int kLeastWidth_px = 320;  // smaller images are drawn twice as large

// In the order of the tracks: B, G, R.
const std::array kColors{cv::Scalar(60, 220, 60), cv::Scalar(40, 120, 255), cv::Scalar(255, 140, 60),
                         cv::Scalar(200, 80, 200), cv::Scalar(60, 220, 220)};

void draw_box(cv::Mat& picture, const std::optional<Box>& box, double scale, const cv::Scalar& color) {
  if (!box) return;
  const auto at = [scale](double value) { return static_cast<int>(std::lround(scale * value)); };
  cv::rectangle(picture, cv::Point(at(box->x), at(box->y)),
                cv::Point(at(box->x + box->width), at(box->y + box->height)), color, 2);
}

cv::Mat drawn(const Image& image, int number, const std::optional<Box>& truth, const std::vector<NamedTrack>& tracks) {
  const double scale = image.bgr.cols < kLeastWidth_px ? 2.0 : 1.0;
  cv::Mat picture;
  cv::resize(image.bgr, picture, {}, scale, scale, cv::INTER_LINEAR);
  draw_box(picture, truth, scale, cv::Scalar(255, 255, 255));
  const auto write = [&](const std::string& words, int line, const cv::Scalar& color) {
    const cv::Point at(6, 16 + 16 * line);
    cv::putText(picture, words, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, cv::Scalar(0, 0, 0), 3, cv::LINE_AA);
    cv::putText(picture, words, at, cv::FONT_HERSHEY_SIMPLEX, 0.45, color, 1, cv::LINE_AA);
  };
  write(fmt::format("{}{}", number, truth ? "" : "  not visible"), 0, cv::Scalar(255, 255, 255));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const cv::Scalar& color = kColors[i % kColors.size()];
    const auto& box = tracks[i].boxes[static_cast<std::size_t>(number)];
    draw_box(picture, box, scale, color);
    write(fmt::format("{}{}", tracks[i].name, box ? "" : ": not found"), static_cast<int>(i) + 1, color);
  }
  return picture;
}

}  // namespace

Result<SequencePictures> write_pictures(const Film& film, const std::vector<NamedTrack>& tracks,
                                        const std::vector<int>& losses, const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::create_directories(folder / "films", ignored);
  std::filesystem::create_directories(folder / "failures", ignored);
  SequencePictures pictures{film.name, fmt::format("films/{}.mp4", film.name), {}};
  std::optional<app::VideoWriter> video;
  for (int i = 0; i < film.size(); ++i) {
    const auto image = film.image(i);
    if (!image) return tl::unexpected(image.error());
    const cv::Mat picture = drawn(*image, i, film.truth[static_cast<std::size_t>(i)], tracks);
    if (!video) {
      auto created = app::VideoWriter::create((folder / pictures.film).string(), picture.size(), kRate_hz);
      if (!created) return tl::unexpected(created.error());
      video = std::move(*created);
    }
    if (auto added = video->add(picture); !added) return tl::unexpected(added.error());
    if (std::ranges::count(losses, i) == 0 || pictures.failures.size() >= kMostFailures) continue;
    const FailurePicture failure{fmt::format("failures/{}-{:04}.jpg", film.name, i),
                                 fmt::format("lost at image {}", i)};
    if (!cv::imwrite((folder / failure.file).string(), picture)) {
      return fail(fmt::format("cannot write {}", (folder / failure.file).string()));
    }
    pictures.failures.push_back(failure);
  }
  if (auto closed = video->close(); !closed) return tl::unexpected(closed.error());
  return pictures;
}

}  // namespace cgsr::lab
