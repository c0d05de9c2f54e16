#include "pipeline/color/track/light_history.h"

#include <algorithm>

namespace cgsr::color {
namespace {

bool same(const Light& a, const Light& b) {
  return a.r == b.r && a.g == b.g && a.b == b.b;
}

}  // namespace

std::optional<Light> LightHistory::add(MonoTime stamp, const std::optional<Light>& light) {
  entries_[next_] = {stamp, light};
  next_ = (next_ + 1) % kMostImages;
  count_ = std::min(count_ + 1, kMostImages);
  while (count_ > 0 && recent(count_ - 1).stamp <= stamp - kSpan) --count_;

  std::optional<Light> plurality;
  std::size_t most = 0;
  for (std::size_t age = 0; age < count_; ++age) {
    const auto& candidate = recent(age).light;
    if (!candidate) continue;
    std::size_t votes = 0;
    for (std::size_t other = 0; other < count_; ++other) {
      const auto& vote = recent(other).light;
      votes += vote && same(*vote, *candidate) ? 1 : 0;
    }
    if (votes > most) {
      most = votes;
      plurality = candidate;
    }
  }
  return plurality;
}

}  // namespace cgsr::color
