#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace cgsr::geometry {

/// The quantile of some values: the one that would have index floor(share n) were they sorted; share 0.5: the median, of an even number the
/// upper one of the middle two. It differs from the first definition in (Hyndman and Fan 1996) where share n is whole.
/// Reorders the values. No allocation.
///
/// \param share  0..1.
/// \return T{} when there are no values.
template <class T>
T quantile(std::span<T> values, double share) {
  if (values.empty()) return T{};
  const auto index = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(index, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Likewise, of a copy.
template <class T>
T quantile(std::vector<T> values, double share) {
  return quantile(std::span<T>(values), share);
}

}  // namespace cgsr::geometry
