#include "pipeline/color/search/divergence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cgsr::color {
namespace {

double phi(double x) {
  return x > 0.0 ? x * std::log(x) : 0.0;
}

}  // namespace

double similarity_term(Divergence divergence, double p, double q) {
  switch (divergence) {
    case Divergence::kHellinger:
      return std::sqrt(p * q);
    case Divergence::kIntersection:
      return std::min(p, q);
    case Divergence::kJensenShannon:
      break;
  }
  return std::max(0.0, (phi(p + q) - phi(p) - phi(q)) / (2.0 * std::numbers::ln2));
}

double divergence_of(Divergence divergence, double similarity) {
  const double lacking = std::clamp(1.0 - similarity, 0.0, 1.0);
  switch (divergence) {
    case Divergence::kHellinger:
      return std::sqrt(lacking);
    case Divergence::kIntersection:
      return lacking;
    case Divergence::kJensenShannon:
      break;
  }
  return std::numbers::ln2 * lacking;
}

double max_divergence(Divergence divergence) {
  return divergence_of(divergence, 0.0);
}

}  // namespace cgsr::color
