#include "hal/sim/render/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

constexpr int kCurve = 65536;
constexpr int kQuantiles = 4096;
constexpr int kRowsPerJob = 16;

// The quantiles at (i + 1/2) / n, out of the integral of the density (trapezoids of 1/2000 sigma), scaled to variance 1.
std::vector<float> normal_quantiles() {
  constexpr double kStep = 1.0 / 2000.0;
  constexpr double kReach = 6.0;
  const auto density = [](double x) { return exponential(-0.5 * x * x) * 0.3989422804014327; };
  std::vector<double> quantiles;
  double below = 0.0;
  double x = -kReach;
  double d = density(x);
  while (quantiles.size() < kQuantiles) {
    const double next_d = density(x + kStep);
    const double area = 0.5 * (d + next_d) * kStep;
    while (quantiles.size() < kQuantiles) {
      const double wanted = (static_cast<double>(quantiles.size()) + 0.5) / kQuantiles;
      if (below + area < wanted && x < kReach) break;
      quantiles.push_back(x + kStep * (wanted - below) / area);
    }
    below += area;
    d = next_d;
    x += kStep;
  }
  double variance = 0.0;
  for (const double q : quantiles) variance += q * q / kQuantiles;
  std::vector<float> scaled;
  scaled.reserve(quantiles.size());
  for (const double q : quantiles) scaled.push_back(static_cast<float>(q / std::sqrt(variance)));
  return scaled;
}

// A 64-bit finaliser (splitmix64): three times twelve good bits out of one call.
std::uint64_t mix64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

// BT.601 in fixed point: coefficients times 2^16 over encoded values 0..65535.
struct Yuv {
  std::int32_t y;  // 8.8 bits
  std::int32_t u;
  std::int32_t v;
};

Yuv to_yuv(const std::array<std::uint16_t, 3>& e) {
  const std::int64_t r = e[0];
  const std::int64_t g = e[1];
  const std::int64_t b = e[2];
  // 65.481, 128.553, 24.966 / -37.797, -74.203, 112 / 112, -93.786, -18.214 over 65535, times 256 and 2^16
  const auto row = [&](std::int64_t cr, std::int64_t cg, std::int64_t cb) {
    return static_cast<std::int32_t>((cr * r + cg * g + cb * b + 32768) >> 16);
  };
  return {row(16763, 32911, 6391), row(-9676, -18996, 28672), row(28672, -24009, -4663)};
}

std::uint8_t byte(std::int32_t eight_dot_eight, int offset) {
  return static_cast<std::uint8_t>(std::clamp(((eight_dot_eight + 128) >> 8) + offset, 1, 254));
}

}  // namespace

Sensor::Sensor() : srgb_(kCurve), normal_(normal_quantiles()) {
  for (int i = 0; i < kCurve; ++i) {
    srgb_[static_cast<std::size_t>(i)] =
        static_cast<std::uint16_t>(std::lround(65535.0 * srgb_encode((i + 0.5) / kCurve)));
  }
  srgb_.front() = 0;
  srgb_.back() = 65535;
}

std::uint16_t Sensor::encode(float linear) const {
  const float clipped = std::min(std::max(linear, 0.0F), 1.0F);
  return srgb_[static_cast<std::size_t>(std::min(clipped * kCurve, static_cast<float>(kCurve - 1)))];
}

double Sensor::measure(const RadianceImage& image, const SensorSettings& settings, std::uint32_t seed,
                       std::uint64_t image_number, const YuyvBuffer& buffer, Workers& workers) const {
  const auto scale = static_cast<float>(settings.exposure_s * settings.gain);
  const auto shot = static_cast<float>(settings.gain / settings.full_well_e);
  const auto read = static_cast<float>(settings.read_noise_e * settings.gain / settings.full_well_e);
  const Rgb balance = settings.white_balance;
  const std::uint64_t image_seed = mix64((static_cast<std::uint64_t>(seed) << 32) ^ mix64(image_number));
  const auto full = static_cast<float>(settings.gain);  // the well holds no more

  const auto pixel = [&](int x, int y) {
    const Eigen::Map<const Rgb> light = image.at(x, y);
    std::array<std::uint16_t, 3> encoded{};
    std::uint64_t random = 0;
    if (settings.noise) random = mix64(image_seed + static_cast<std::uint64_t>(y * image.width_px + x));
    for (std::size_t c = 0; c < 3; ++c) {
      float value = std::min(light[static_cast<int>(c)] * scale, full);
      if (settings.noise) {
        value += std::sqrt(value * shot + read * read) * normal_[(random >> (12 * c)) & (kQuantiles - 1)];
      }
      encoded[c] = encode(value * balance[static_cast<int>(c)]);
    }
    return to_yuv(encoded);
  };
  const int jobs = (image.height_px + kRowsPerJob - 1) / kRowsPerJob;
  std::vector<std::int64_t> luma(static_cast<std::size_t>(jobs), 0);
  workers.run(jobs, [&](int job) {
    for (int y = job * kRowsPerJob; y < std::min((job + 1) * kRowsPerJob, image.height_px); ++y) {
      std::uint8_t* out = buffer.data + y * buffer.stride_bytes;
      for (int x = 0; x + 1 < image.width_px; x += 2, out += 4) {
        const Yuv a = pixel(x, y);
        const Yuv b = pixel(x + 1, y);
        out[0] = byte(a.y, 16);
        out[1] = byte((a.u + b.u) >> 1, 128);
        out[2] = byte(b.y, 16);
        out[3] = byte((a.v + b.v) >> 1, 128);
        luma[static_cast<std::size_t>(job)] += out[0] + out[2] - 32;
      }
    }
  });
  std::int64_t sum = 0;
  for (const std::int64_t part : luma) sum += part;
  return static_cast<double>(sum) / (219.0 * image.width_px * image.height_px);
}

SensorSettings AutoExposure::next(const SensorSettings& settings, double mean_luma) const {
  // In linear light, roughly: the goal over what was met, taken `speed` of the way. x^speed by its chord on 1/8..8.
  const double ratio = std::clamp(srgb_decode(goal_luma) / std::max(srgb_decode(mean_luma), 1e-3), 0.125, 8.0);
  const double factor = ratio >= 1.0 ? 1.0 + speed * (ratio - 1.0) : 1.0 / (1.0 + speed * (1.0 / ratio - 1.0));
  const double wanted = settings.exposure_s * settings.gain * factor;
  SensorSettings next = settings;
  next.exposure_s = std::clamp(wanted, shortest_exposure_s, longest_exposure_s);
  next.gain = std::clamp(wanted / next.exposure_s, 1.0, most_gain);
  return next;
}

}  // namespace cgsr::sim
