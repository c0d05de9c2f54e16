#include "hal/sim/scene/lamp.h"

#include <algorithm>

namespace cgsr::sim {

Rgb factor_at(const std::vector<LightKey>& script, double time_s) {
  if (script.empty()) return Rgb::Ones();
  const auto after = std::find_if(script.begin(), script.end(), [&](const LightKey& key) { return key.at_s > time_s; });
  if (after == script.begin()) return after->factor;
  if (after == script.end()) return script.back().factor;
  const LightKey& before = *(after - 1);
  const auto share = static_cast<float>((time_s - before.at_s) / (after->at_s - before.at_s));
  return before.factor + share * (after->factor - before.factor);
}

}  // namespace cgsr::sim
