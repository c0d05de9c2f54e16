#pragma once

#include <cstdint>
#include <span>

namespace cgsr::lab {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The 95 % interval of a share, after Wilson: it stays inside [0, 1] and is right near its ends.
/// \return {0, 1} without trials.
Interval wilson(int successes, int trials);

/// The 95 % interval of the mean by percentile bootstrap, 2000 draws.
///
/// \param values  in the order in which they were measured.
/// \param block  how many neighbours are drawn together: 1 for independent values; for the images of a video, where one image
///        resembles the next, about as many as stay alike.
/// \param seed  same seed, same interval.
Interval bootstrap_mean(std::span<const double> values, int block, std::uint64_t seed);

/// The same for the mean of several groups' means: every draw takes each group anew, so that a long group weighs as much as a short one.
Interval bootstrap_mean_of_means(std::span<const std::span<const double>> groups, int block, std::uint64_t seed);

/// Student's t-test of paired differences: whether their mean is 0.
struct PairedTest {
  double mean = 0.0;
  Interval interval;  ///< 95 %, of the mean, if differences are normal.
  double t = 0.0;
  double p = 1.0;  ///< both sides.
};

/// \return all zero and p = 1 for fewer than two differences.
PairedTest paired_t_test(std::span<const double> differences);

double mean(std::span<const double> values);

/// \return the value that a share of the values is not above; 0 without values.
double quantile(std::span<const double> values, double share);

/// The 95 % interval of a quantile by order statistics, whatever the distribution: the ranks within 1.96 sigma of the binomial's mean.
/// \return the smallest and the largest value where there are too few. {0, 0} without values.
Interval quantile_interval(std::span<const double> values, double share);

}  // namespace cgsr::lab
