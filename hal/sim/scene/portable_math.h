#pragma once

#include <cstdint>

namespace cgsr::sim {

/// Elementary functions whose last bit is the same on every machine. libc picks its own versions (with or without fused
/// multiply-add) by the CPU it finds; these use + - * / and sqrt only, which IEEE 754 fixes.
/// Accuracy: a few units of the last place of a double. None of them is meant for the inner loop over pixels.

double sine(double angle_rad);           ///< |angle| < 1e6.
double cosine(double angle_rad);         ///< |angle| < 1e6.
double arc_tangent(double y, double x);  ///< in (-pi, pi]; 0 for (0, 0).
double exponential(double x);            ///< |x| < 700.

/// The sRGB transfer curve (IEC 61966-2-1), both ways. Outside 0..1 the ends hold.
double srgb_encode(double linear);
double srgb_decode(double encoded);

constexpr double kPi = 3.14159265358979323846;
constexpr double degrees(double value) {
  return value * (kPi / 180.0);
}

/// The angle in (-pi, pi] that differs from `angle_rad` by full turns.
double wrap_angle(double angle_rad);

/// A well mixed 32-bit hash (the finaliser of MurmurHash3): randomness that depends on what it is for, never on who
/// computes it first.
constexpr std::uint32_t mix(std::uint32_t h) {
  h ^= h >> 16;
  h *= 0x85ebca6bU;
  h ^= h >> 13;
  h *= 0xc2b2ae35U;
  h ^= h >> 16;
  return h;
}
constexpr std::uint32_t mix(std::uint32_t a, std::uint32_t b) {
  return mix(mix(a) + 0x9e3779b9U * (b + 1));
}
constexpr std::uint32_t mix(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return mix(mix(a, b), c);
}

/// Uniform in [0, 1) out of a hash: 24 bits, exact in a float.
constexpr float unit(std::uint32_t hash) {
  return static_cast<float>(hash >> 8) * (1.0F / 16777216.0F);
}

}  // namespace cgsr::sim
