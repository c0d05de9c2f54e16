#include "pipeline/color/search/similarity.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cgsr::color {

int level_of(int count, int pixels) {
  const std::int64_t scaled = std::int64_t{4} * (kLevels - 1) * (kLevels - 1) * std::min(count, pixels);
  int level = 0;
  while (level < kLevels - 1 && scaled >= std::int64_t{pixels} * (2 * level + 1) * (2 * level + 1)) ++level;
  return level;
}

Labels labels_of(const ColorModel& model) {
  const auto bins = static_cast<std::size_t>(model.bins.count());
  std::vector<int> mass(bins, 0);
  for (std::size_t light = 0; light < model.lights.size(); ++light) {
    const auto row = model.object_under(light);
    for (std::size_t bin = 0; bin < bins; ++bin) mass[bin] += row[bin];
  }
  Labels labels;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (mass[bin] > 0) labels.bins.push_back(static_cast<int>(bin));
  }
  std::stable_sort(labels.bins.begin(), labels.bins.end(),
                   [&](int a, int b) { return mass[static_cast<std::size_t>(a)] > mass[static_cast<std::size_t>(b)]; });

  std::vector<std::uint16_t> label_of_bin(bins, 0);
  for (std::size_t i = 0; i < labels.bins.size(); ++i)
    label_of_bin[static_cast<std::size_t>(labels.bins[i])] = static_cast<std::uint16_t>(i + 1);
  labels.of_code.resize(imaging::kColorCodes);
  for (int code = 0; code < imaging::kColorCodes; ++code) {
    const int bin = imaging::bin_of(model.bins, imaging::rgb_of_code(static_cast<std::uint16_t>(code)));
    labels.of_code[static_cast<std::size_t>(code)] = label_of_bin[static_cast<std::size_t>(bin)];
  }
  return labels;
}

Similarity::Similarity(const ColorModel& model, const SearchParameters& parameters, const Labels& labels)
    : lights_(static_cast<int>(model.lights.size())),
      labels_(labels.count()),
      units_(static_cast<std::size_t>(labels_) * kLevels * static_cast<std::size_t>(lights_), 0) {
  const bool weighted = parameters.weights == BinWeights::kSurroundings && !model.surroundings.empty();
  for (std::size_t light = 0; light < model.lights.size(); ++light) {
    const auto object = model.object_under(light);
    const auto around = model.surroundings_under(light);
    const auto weight = [&](std::size_t bin) {
      if (!weighted || object[bin] == 0) return 1.0;
      return std::max(parameters.min_weight, 1.0 * object[bin] / (object[bin] + around[bin]));
    };
    double whole = 0.0;
    for (std::size_t bin = 0; bin < object.size(); ++bin) whole += weight(bin) * object[bin] / kHistogramMass;
    for (std::size_t i = 0; i < labels.bins.size(); ++i) {
      const auto bin = static_cast<std::size_t>(labels.bins[i]);
      const double q = 1.0 * object[bin] / kHistogramMass;
      for (std::size_t level = 0; level < kLevels; ++level) {
        const double root = static_cast<double>(level) / (kLevels - 1);
        const double p = weighted ? std::min(root * root, q) : root * root;
        const double term = similarity_term(parameters.divergence, p, q);
        units_[(i * kLevels + level) * model.lights.size() + light] =
            static_cast<std::int16_t>(std::floor(kOne * weight(bin) * term / whole));
      }
    }
  }
}

double divergence_of_units(Divergence divergence, int units) {
  return divergence_of(divergence, static_cast<double>(units) / kOne);
}

int min_units(Divergence divergence, double max_divergence) {
  int low = 0, high = kMaxUnits + 1;  // the divergence falls with the units
  while (low < high) {
    const int middle = (low + high) / 2;
    if (divergence_of_units(divergence, middle) <= max_divergence) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

}  // namespace cgsr::color
