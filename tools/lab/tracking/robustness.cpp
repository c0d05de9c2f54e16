#include "tools/lab/tracking/robustness.h"

#include <array>

namespace cgsr::lab {
namespace {

constexpr int kLeastImagesLeft = 10;

Box shifted(const Box& box, double dx, double dy) {
  return {box.x + dx, box.y + dy, box.width, box.height};
}

Box scaled(const Box& box, double by) {
  return {box.x + box.width * (1 - by) / 2, box.y + box.height * (1 - by) / 2, box.width * by, box.height * by};
}

}  // namespace

std::vector<RunStart> spatial_starts(const Box& first, const cv::Size& image) {
  constexpr double kShift = 0.1;
  constexpr std::array kWays{-1, 0, 1};
  constexpr std::array kScales{0.8, 0.9, 1.1, 1.2};
  const Box whole{0, 0, static_cast<double>(image.width), static_cast<double>(image.height)};
  std::vector<RunStart> starts;
  for (const int y : kWays) {
    for (const int x : kWays) {
      if (x == 0 && y == 0) continue;
      const Box box = shifted(first, kShift * x * first.width, kShift * y * first.height);
      starts.push_back({0, intersection(box, whole)});
    }
  }
  for (const double scale : kScales) starts.push_back({0, intersection(scaled(first, scale), whole)});
  return starts;
}

std::vector<RunStart> temporal_starts(const Boxes& truth, int count) {
  const auto images = static_cast<int>(truth.size());
  std::vector<RunStart> starts;
  for (int k = 0; k < count; ++k) {
    int image = k * images / count;
    while (image < images && !truth[static_cast<std::size_t>(image)]) ++image;
    if (image > images - kLeastImagesLeft && k > 0) break;
    if (!starts.empty() && starts.back().image >= image) continue;
    starts.push_back({image, *truth[static_cast<std::size_t>(image)]});
  }
  return starts;
}

std::vector<RunStart> half_pixel_starts(const Box& first) {
  constexpr double kHalf = 0.5;
  return {{0, shifted(first, -kHalf, 0)},
          {0, shifted(first, kHalf, 0)},
          {0, shifted(first, 0, -kHalf)},
          {0, shifted(first, 0, kHalf)}};
}

}  // namespace cgsr::lab
