#include "hal/sim/scene/portable_math.h"

#include <algorithm>
#include <cmath>

namespace cgsr::sim {
namespace {

// Taylor series on |x| <= pi/4: the next terms are below 1e-17.
double sine_near_zero(double x) {
  const double x2 = x * x;
  double sum = 0.0;
  for (int k = 19; k >= 3; k -= 2) sum = (1.0 + sum) * (-x2 / (k * (k - 1)));
  return x * (1.0 + sum);
}

double cosine_near_zero(double x) {
  const double x2 = x * x;
  double sum = 0.0;
  for (int k = 20; k >= 2; k -= 2) sum = (1.0 + sum) * (-x2 / (k * (k - 1)));
  return 1.0 + sum;
}

struct Reduced {
  double rest;
  int quadrant;
};

// x = quadrant * pi/2 + rest, pi/2 in two parts so that the difference keeps its digits.
Reduced reduce(double x) {
  constexpr double kHalfPiHigh = 1.57079632673412561417e+00;
  constexpr double kHalfPiLow = 6.07710050650619224932e-11;
  const double turns = std::floor(x / (kPi / 2.0) + 0.5);
  return {(x - turns * kHalfPiHigh) - turns * kHalfPiLow, static_cast<int>(static_cast<long long>(turns) & 3)};
}

// Newton's iteration for x^(1/n), from above.
double root(double x, int n) {
  if (x <= 0.0) return 0.0;
  double y = std::max(1.0, x);
  for (int i = 0; i < 200; ++i) {
    double power = 1.0;
    for (int k = 0; k < n - 1; ++k) power *= y;
    const double next = y - (y - x / power) / n;
    if (!(next < y)) break;
    y = next;
  }
  return y;
}

}  // namespace

double sine(double angle_rad) {
  const auto [rest, quadrant] = reduce(angle_rad);
  const double value = (quadrant & 1) != 0 ? cosine_near_zero(rest) : sine_near_zero(rest);
  return (quadrant & 2) != 0 ? -value : value;
}

double cosine(double angle_rad) {
  const auto [rest, quadrant] = reduce(angle_rad);
  const double value = (quadrant & 1) != 0 ? sine_near_zero(rest) : cosine_near_zero(rest);
  return quadrant == 1 || quadrant == 2 ? -value : value;
}

// Newton on the angle itself: with r the length, y cos(a) - x sin(a) = r sin(error).
double arc_tangent(double y, double x) {
  const double length = std::sqrt(x * x + y * y);
  if (!(length > 0.0)) return 0.0;
  double angle = y >= 0.0 ? kPi / 2.0 * (1.0 - x / length) : -kPi / 2.0 * (1.0 - x / length);
  for (int i = 0; i < 4; ++i) {
    const double s = (y * cosine(angle) - x * sine(angle)) / length;
    angle += s * (1.0 + s * s / 6.0);
  }
  return wrap_angle(angle);
}

double exponential(double x) {
  constexpr double kLn2 = 0.693147180559945309417;
  const double twos = std::floor(x / kLn2 + 0.5);
  const double rest = x - twos * kLn2;
  double sum = 1.0;
  for (int k = 18; k >= 1; --k) sum = 1.0 + sum * rest / k;
  return std::ldexp(sum, static_cast<int>(twos));
}

double srgb_encode(double linear) {
  if (!(linear > 0.0)) return 0.0;
  if (linear >= 1.0) return 1.0;
  if (linear <= 0.0031308) return 12.92 * linear;
  const double x2 = linear * linear;
  return 1.055 * std::sqrt(std::sqrt(root(x2 * x2 * linear, 3))) - 0.055;  // 1/2.4 = 5/12
}

double srgb_decode(double encoded) {
  if (!(encoded > 0.0)) return 0.0;
  if (encoded >= 1.0) return 1.0;
  if (encoded <= 0.04045) return encoded / 12.92;
  const double x = (encoded + 0.055) / 1.055;
  const double x2 = x * x;
  return x2 * root(x2, 5);  // 2.4 = 2 + 2/5
}

double wrap_angle(double angle_rad) {
  const double wrapped = angle_rad - 2.0 * kPi * std::floor((angle_rad + kPi) / (2.0 * kPi));
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace cgsr::sim
