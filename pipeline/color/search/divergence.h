#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "platform/parameters.h"

namespace cgsr::color {

/// How two histograms are compared: the DistanceMetric of Alg. 3.2, line 7 (Jensen-Shannon, the dissertation's: Lin 1991; Hellinger:
/// Comaniciu et al. 2003; intersection: Swain and Ballard 1991). Each is a decreasing function of a similarity, a sum over the bins of a
/// term that grows with both shares: what the search's bounds rest on. With p the window's share of a bin and q the learned one:
enum class Divergence : std::uint8_t {
  kJensenShannon,  ///< ln 2 (1 - S) nat,  S = sum [phi(p+q) - phi(p) - phi(q)] / (2 ln 2),  phi(x) = x ln x
  kHellinger,      ///< sqrt(1 - S),  S = sum sqrt(p q), Bhattacharyya's coefficient
  kIntersection,   ///< 1 - S,  S = sum min(p, q)
};

inline constexpr std::array kDivergenceNames{
    Named<Divergence>{"jensen_shannon", Divergence::kJensenShannon},
    Named<Divergence>{"hellinger", Divergence::kHellinger},
    Named<Divergence>{"intersection", Divergence::kIntersection},
};
constexpr std::string_view to_string(Divergence divergence) {
  return word_in(kDivergenceNames, divergence);
}

/// \return one bin's contribution to the similarity; the sum over the bins of two equal histograms is 1. \param p, q  in [0, 1].
double similarity_term(Divergence divergence, double p, double q);

/// \return the divergence that a similarity stands for; a similarity above 1 (rounding) counts as 1.
double divergence_of(Divergence divergence, double similarity);

/// \return the largest divergence of all: that of two histograms without a common bin.
double max_divergence(Divergence divergence);

}  // namespace cgsr::color
