#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "pipeline/color/learn/learn.h"
#include "pipeline/imaging/color_code.h"
#include "pipeline/imaging/reduce.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::test {

/// A YUYV image painted for a test.
class Painting {
 public:
  Painting(int width_px, int height_px)
      : width_px_(width_px), height_px_(height_px), pixels_(static_cast<std::size_t>(width_px * height_px)) {}

  /// Paints by a colour for every pixel.
  void paint(const std::function<imaging::Rgb(int, int)>& color) {
    for (int y = 0; y < height_px_; ++y) {
      for (int x = 0; x < width_px_; ++x) at(x, y) = color(x, y);
    }
  }
  void fill(const Box& box, const imaging::Rgb& color) {
    for (int y = std::max(0, static_cast<int>(box.y)); y < std::min<double>(height_px_, box.y + box.height); ++y) {
      for (int x = std::max(0, static_cast<int>(box.x)); x < std::min<double>(width_px_, box.x + box.width); ++x)
        at(x, y) = color;
    }
  }
  imaging::Rgb& at(int x, int y) { return pixels_[static_cast<std::size_t>(y * width_px_ + x)]; }

  /// The camera's view of it. \param noise  standard deviation of Y, U and V in steps of 8 bits.
  ImageView photograph(double noise = 0.0, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    const auto byte = [&](double value, double from, double to) {
      const double noisy = value + (noise > 0.0 ? noise * normal(random) : 0.0);
      return static_cast<std::uint8_t>(std::lround(std::clamp(noisy, from, to)));
    };
    yuyv_.clear();
    for (std::size_t i = 0; i < pixels_.size(); i += 2) {
      const auto a = imaging::yuv_of_rgb(pixels_[i]);
      const auto b = imaging::yuv_of_rgb(pixels_[i + 1]);
      yuyv_.push_back(byte(a.y, 16, 235));
      yuyv_.push_back(byte((a.u + b.u) / 2, 16, 240));
      yuyv_.push_back(byte(b.y, 16, 235));
      yuyv_.push_back(byte((a.v + b.v) / 2, 16, 240));
    }
    return {yuyv_.data(), width_px_, height_px_, width_px_ * 2, PixelFormat::kYuyv};
  }

 private:
  int width_px_;
  int height_px_;
  std::vector<imaging::Rgb> pixels_;
  std::vector<std::uint8_t> yuyv_;
};

/// Patches of random colours over each other.
inline Painting clutter(int width_px, int height_px, std::mt19937& random, int patches = 25) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto color = [&] { return imaging::Rgb{unit(random), unit(random), unit(random)}; };
  Painting painting(width_px, height_px);
  const auto ground = color();
  painting.paint([&](int, int) { return ground; });
  for (int i = 0; i < patches; ++i) {
    painting.fill({unit(random) * width_px - 4, unit(random) * height_px - 4, 2 + unit(random) * width_px / 3,
                   2 + unit(random) * height_px / 3},
                  color());
  }
  return painting;
}

/// Three colours that a model can be learned from: red above, white in the middle, blue below.
inline void paint_flag(Painting& painting, const Box& box, const color::Light& light = {0.8, 0.8, 0.8}) {
  const double third = box.height / 3.0;
  painting.fill({box.x, box.y, box.width, third}, color::lit({0.9, 0.2, 0.15}, light));
  painting.fill({box.x, box.y + third, box.width, third}, color::lit({0.95, 0.9, 0.9}, light));
  painting.fill({box.x, box.y + 2 * third, box.width, third}, color::lit({0.15, 0.3, 0.85}, light));
}

}  // namespace cgsr::test
