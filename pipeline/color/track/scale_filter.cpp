#include "pipeline/color/track/scale_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::color {
namespace {

constexpr int kCell_px = 4;
constexpr double kMeanSide_px = 24.0;
constexpr int kShortestSide_px = 12;
constexpr int kLongestSide_px = 48;
constexpr double kLeastSteps = 0.25;

int patch_side(double wanted_px) {
  const int cells = static_cast<int>(std::lround(wanted_px / kCell_px));
  return std::clamp(cells * kCell_px, kShortestSide_px, kLongestSide_px);
}

/// A patch of the box's shape and of about 24x24 pixels.
imaging::PatchSize patch_of(const Box& box) {
  const double shape = std::sqrt(box.width / box.height);
  return {patch_side(kMeanSide_px * shape), patch_side(kMeanSide_px / shape)};
}

Box grown(const Box& box, double factor) {
  return {box.x - 0.5 * box.width * (factor - 1.0), box.y - 0.5 * box.height * (factor - 1.0), box.width * factor,
          box.height * factor};
}

}  // namespace

ScaleFilter::ScaleFilter(const ScaleParameters& parameters) : parameters_(parameters) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::array<double, kScales> wanted{};
  const double sigma = kScales / std::sqrt(33.0) * 0.25;  // DSST's, for 33 scales: sqrt(33) / 4
  for (int n = 0; n < kScales; ++n) {
    const auto i = static_cast<std::size_t>(n);
    const int step = n - kScales / 2;
    factors_[i] = std::pow(parameters.step, step);
    window_[i] = static_cast<float>(0.5 - 0.5 * std::cos(kTurn * (n + 1) / (kScales + 1)));
    wanted[i] = std::exp(-0.5 * step * step / (sigma * sigma));
  }
  for (int k = 0; k < kFrequencies; ++k) {
    double re = 0.0;
    double im = 0.0;
    for (int n = 0; n < kScales; ++n) {
      const double angle = -kTurn * (k * n % kScales) / kScales;
      const auto i = static_cast<std::size_t>(n);
      rotation_[static_cast<std::size_t>(k)][i] = {static_cast<float>(std::cos(angle)),
                                                   static_cast<float>(std::sin(angle))};
      re += wanted[i] * std::cos(angle);
      im += wanted[i] * std::sin(angle);
    }
    target_[static_cast<std::size_t>(k)] = {static_cast<float>(re), static_cast<float>(im)};
  }
  samples_.resize(static_cast<std::size_t>(kScales) * kMostFeatures);
  for (auto* spectra : {&re_, &im_, &numerator_re_, &numerator_im_, &first_numerator_re_, &first_numerator_im_}) {
    for (auto& values : *spectra) values.resize(kMostFeatures);
  }
}

void ScaleFilter::begin(const imaging::Pyramid& image, const Box& box) {
  patch_ = patch_of(box);
  features_count_ = patch_.area() / (kCell_px * kCell_px) * kOrientations;
  for (auto* spectra : {&numerator_re_, &numerator_im_}) {
    for (auto& values : *spectra) std::fill(values.begin(), values.end(), 0.0F);
  }
  denominator_.fill(0.0F);
  described_ = {};  // the patch may have another shape now
  describe(image, box);
  absorb(1.0F);
  first_numerator_re_ = numerator_re_;
  first_numerator_im_ = numerator_im_;
  first_denominator_ = denominator_;
}

void ScaleFilter::forget() {
  numerator_re_ = first_numerator_re_;
  numerator_im_ = first_numerator_im_;
  denominator_ = first_denominator_;
}

void ScaleFilter::learn(const imaging::Pyramid& image, const Box& box) {
  const auto steps = steps_from_described(image, box);
  if (!steps) describe(image, box);
  absorb(static_cast<float>(parameters_.learning_rate), steps.value_or(0.0));
}

/// \return how many steps larger `box` is than the one described, if that is about the same centre and few.
std::optional<double> ScaleFilter::steps_from_described(const imaging::Pyramid& image, const Box& box) const {
  constexpr double kMostSteps = kScales / 4.0;
  constexpr double kSameCentre_px = 0.01;
  if (image.builds() != described_build_) return std::nullopt;
  const double dx = box.x + 0.5 * box.width - described_.x - 0.5 * described_.width;
  const double dy = box.y + 0.5 * box.height - described_.y - 0.5 * described_.height;
  if (std::hypot(dx, dy) > kSameCentre_px) return std::nullopt;
  const double steps = std::log(box.width / described_.width) / std::log(parameters_.step);
  if (std::abs(steps) > kMostSteps) return std::nullopt;
  return steps;
}

void ScaleFilter::describe(const imaging::Pyramid& image, const Box& box) {
  if (box == described_ && image.builds() == described_build_) return;
  described_ = box;
  described_build_ = image.builds();
  std::array<std::uint8_t, static_cast<std::size_t>(kLongestSide_px) * kLongestSide_px> luma;
  for (std::size_t n = 0; n < kScales; ++n) {
    image.sample_luma(grown(box, factors_[n]), patch_, luma);
    const std::span<float> features(samples_.data() + n * features_count_, features_count_);
    orientation_histograms({luma.data(), patch_.area()}, patch_, kCell_px, features);
    for (float& feature : features) feature *= window_[n];
  }
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    float* re = re_[k].data();
    float* im = im_[k].data();
    std::fill_n(re, features_count_, 0.0F);
    std::fill_n(im, features_count_, 0.0F);
    for (std::size_t n = 0; n < kScales; ++n) {
      const float* sample = samples_.data() + n * features_count_;
      const Complex turn = rotation_[k][n];
      for (std::size_t d = 0; d < features_count_; ++d) {
        re[d] += sample[d] * turn.re;
        im[d] += sample[d] * turn.im;
      }
    }
  }
}

void ScaleFilter::absorb(float rate, double growth_steps) {
  const float keep = 1.0F - rate;
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    const double angle = -2.0 * std::numbers::pi * static_cast<double>(k) * growth_steps / kScales;
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    const Complex g{target_[k].re * c - target_[k].im * s, target_[k].re * s + target_[k].im * c};
    float power = 0.0F;
    for (std::size_t d = 0; d < features_count_; ++d) {
      const float re = re_[k][d];
      const float im = im_[k][d];
      numerator_re_[k][d] = keep * numerator_re_[k][d] + rate * (g.re * re + g.im * im);
      numerator_im_[k][d] = keep * numerator_im_[k][d] + rate * (g.re * im - g.im * re);
      power += re * re + im * im;
    }
    denominator_[k] = keep * denominator_[k] + rate * power;
  }
}

double ScaleFilter::estimate(const imaging::Pyramid& image, const Box& box) {
  describe(image, box);
  std::array<Complex, kFrequencies> answer{};
  for (std::size_t k = 0; k < kFrequencies; ++k) {
    float re = 0.0F;
    float im = 0.0F;
    for (std::size_t d = 0; d < features_count_; ++d) {
      re += numerator_re_[k][d] * re_[k][d] + numerator_im_[k][d] * im_[k][d];
      im += numerator_re_[k][d] * im_[k][d] - numerator_im_[k][d] * re_[k][d];
    }
    const float scale = 1.0F / (denominator_[k] + static_cast<float>(parameters_.regularisation));
    answer[k] = {re * scale, im * scale};
  }
  std::array<double, kScales> response{};
  for (std::size_t n = 0; n < kScales; ++n) {
    double sum = answer[0].re;
    for (std::size_t k = 1; k < kFrequencies; ++k) {  // the other half of the spectrum is the conjugate
      sum += 2.0 * (answer[k].re * rotation_[k][n].re + answer[k].im * rotation_[k][n].im);
    }
    response[n] = sum;
  }
  const auto best = static_cast<std::size_t>(std::max_element(response.begin(), response.end()) - response.begin());
  double position = static_cast<double>(best);
  if (best > 0 && best + 1 < kScales) {
    const double curvature = response[best - 1] - 2.0 * response[best] + response[best + 1];
    if (curvature < -1e-9)
      position += std::clamp(0.5 * (response[best - 1] - response[best + 1]) / curvature, -0.5, 0.5);
  }
  constexpr int kUnchanged = kScales / 2;
  const double steps = position - kUnchanged;
  return std::abs(steps) < kLeastSteps ? 1.0 : std::pow(parameters_.step, steps);
}

}  // namespace cgsr::color
