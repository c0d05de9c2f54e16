#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/color/learn/light.h"
#include "platform/error.h"
#include "tools/lab/statistics.h"

namespace cgsr::lab {

/// What a figure has to keep to.
struct Requirement {
  enum class Kind : std::uint8_t {
    kAtMost,
    kAtLeast,
    kIntervalWithin,  ///< both ends of the 95 % interval are at most `bound` from 0.
  };
  double bound = 0.0;
  Kind kind = Kind::kAtMost;
};
std::string_view to_string(Requirement::Kind kind);

/// How a row of one run and the same row of another are joined into one.
enum class Join : std::uint8_t {
  kWeighted,  ///< the mean of the runs' figures, weighted with their trials.
  kMean,      ///< the mean of all samples.
  kShare,     ///< successes of all trials.
  kMax,
  kMin,
  kMedian,   ///< of all samples.
  kP95,      ///< the 95 % quantile of all samples.
  kPaired,   ///< the mean of paired differences, its interval by Student's t-test.
  kPairedP,  ///< that test's p.
};
std::string_view to_string(Join join);

/// One measured figure beside the dissertation's.
struct Row {
  std::string row;       ///< what was measured, e.g. "coke / KCF"
  std::string quantity;  ///< e.g. "precision"
  std::string unit;      ///< SI or the like; empty for shares
  std::optional<double> dissertation;
  std::optional<double> ours;
  std::optional<Interval> interval;  ///< 95 %; none for counts that repeat exactly
  int trials = 0;
  std::optional<Requirement> requirement = {};
  Join join = Join::kWeighted;
  std::vector<double> samples = {};  ///< one per trial, where `join` needs them; for kWeighted the figure of each run.
  std::vector<double> weights = {};  ///< for kWeighted: the trials of each run.

  /// \return whether the figure itself keeps to the requirement; nothing: nothing is required, or nothing was measured.
  [[nodiscard]] std::optional<bool> met() const;
  /// \return whether the whole interval says the same as the figure; true without an interval.
  [[nodiscard]] bool sure() const;
};

struct Curve {
  struct Point {
    double x;
    double y;
    std::optional<Interval> interval;
  };
  std::string name;
  std::vector<Point> points;
};

struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Curve> curves;
};

/// Colours of light in a row of equal steps, band under band, as in the dissertation's Figure 3.3.
struct Stripe {
  struct Band {
    std::string name;
    std::vector<std::optional<color::Light>> colors;  ///< 0 to 1, encoded; nothing: none was there to tell
  };
  std::string title;
  std::vector<Band> bands;  ///< equally long
};

/// For the page alone.
struct Picture {
  std::string caption;
  std::vector<std::uint8_t> jpeg;
};

/// One run of a table: a seed with its trials.
struct Run {
  std::uint64_t seed = 0;
  int trials = 0;
  std::string commit;  ///< of the sources; with "+changes" where they were not committed.
};

/// Trials of a table's first run that were measured again after something had changed, and gave the same figures.
struct Repetition {
  std::string commit;  ///< of the sources then.
  int trials = 0;
  int figures = 0;  ///< that were compared.
};

/// A table or figure, reproduced.
struct Report {
  std::string name;
  std::string title;
  std::string config_sha256;
  std::uint64_t seed = 0;
  std::vector<Row> rows;
  std::vector<Plot> plots;
  std::vector<std::string> notes;  ///< what a reader has to know to read the figures rightly; a sentence each
  std::vector<Stripe> stripes = {};
  std::vector<Picture> pictures = {};
  std::string sources_sha256 = {};            ///< of the rooms that it measures.
  std::vector<Run> runs = {};                 ///< those that its rows are made of.
  std::optional<Repetition> repetition = {};  ///< the last one; the hashes are of its configuration and sources.
};

/// \return the value in the digits that a stored report keeps of samples.
double stored_digits(double value);

/// A figure without an interval.
Row plain_row(std::string row, std::string quantity, std::string unit, double value, std::size_t trials,
              Join join = Join::kWeighted);

/// The figure that the samples give: its value, its 95 % interval and its trials.
/// \param join  one of those that need samples.  \param seed  of the bootstrap.
Row sampled_row(std::string row, std::string quantity, std::string unit, std::vector<double> samples, Join join,
                std::uint64_t seed);

/// A row measured as the mean of independent trials.
Row mean_row(std::string row, std::string quantity, std::string unit, const std::vector<double>& values,
             std::uint64_t seed);

/// A row that is a share of trials.
Row share_row(std::string row, std::string quantity, int successes, int trials);

/// \return the report as a table for the terminal: a line per row, a column per quantity.
std::string to_text(const Report& report);

/// \return [{"name", "title", "config_sha256", "sources_sha256", "seed", "seeds": [], "runs": [{"seed", "trials", "commit"}],
///         "repetition": {"commit", "trials", "figures"} or null,
///         "rows": [{"row", "quantity", "unit", "dissertation", "ours", "interval", "trials", "requirement", "met", "join"}], "notes": []}].
///         "requirement" is {"at_most": B}, {"at_least": B} or null; a row that more trials can join has "samples" and "weights" too.
nlohmann::json to_json(const std::vector<Report>& reports);

/// The same as text, a line a row.
std::string to_json_text(const std::vector<Report>& reports);

/// \return the reports of such a text; or what in it is not as to_json() writes it.
Result<std::vector<Report>> reports_of(std::string_view json);

/// \return one self-contained page: tables and inline SVG, no script.
std::string to_html(const std::vector<Report>& reports);

}  // namespace cgsr::lab
