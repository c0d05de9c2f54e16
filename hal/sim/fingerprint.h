#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "hal/sim/render/photographer.h"
#include "platform/config/sha256.h"

namespace cgsr::sim {

/// SHA-256 over values, member by member: padding never takes part, and lists carry their length.
class Fingerprint {
 public:
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    sum_.add(&value, sizeof value);
  }

  template <class T>
  void numbers(const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T>);
    number(values.size());
    sum_.add(values.data(), values.size() * sizeof(T));
  }

  template <class Derived>
  void matrix(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index column = 0; column < m.cols(); ++column) {
      for (Eigen::Index row = 0; row < m.rows(); ++row) number(m(row, column));
    }
  }

  void text(std::string_view text);

  /// \return 64 hexadecimal digits; ends the sum.
  std::string hex() { return sum_.hex(); }

 private:
  config::Sha256 sum_;
};

/// What an image of the scene depends on, beside its state: meshes, materials, textures, lamps' sizes. Names and scripts do not take part.
std::string fingerprint(const Scene& scene);

/// A lens and how finely edges are drawn; how many threads draw does not matter.
void add(Fingerprint& sum, const CameraModel& camera);
void add(Fingerprint& sum, const SensorSettings& settings);
void add(Fingerprint& sum, const Moment& moment);

/// The code that draws: the build identities of the simulator and of every library that the process has loaded, in an order that does not depend
/// on loading. Any change to any of them makes another one. A program that loads the simulator as a plug-in takes no part: its other builds, and
/// the same under valgrind, find the same images.
std::string program_fingerprint();

}  // namespace cgsr::sim
