#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "pipeline/color/learn/light.h"
#include "tools/lab/statistics.h"

namespace cgsr::lab {

/// One measured figure beside the dissertation's.
struct Row {
  std::string row;       ///< what was measured, e.g. "coke / KCF"
  std::string quantity;  ///< e.g. "precision"
  std::string unit;      ///< SI or the like; empty for shares
  std::optional<double> dissertation;
  std::optional<double> ours;
  std::optional<Interval> interval;  ///< 95 %; none for counts that repeat exactly
  int trials = 0;
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
};

/// A figure without an interval.
Row plain_row(std::string row, std::string quantity, std::string unit, double value, std::size_t trials);

/// A row measured as the mean of independent trials.
Row mean_row(std::string row, std::string quantity, std::string unit, const std::vector<double>& values,
             std::uint64_t seed);

/// A row that is a share of trials.
Row share_row(std::string row, std::string quantity, int successes, int trials);

/// \return the report as a table for the terminal: a line per row, a column per quantity.
std::string to_text(const Report& report);

/// \return [{"name", "config_sha256", "seed", "rows": [{"row", "quantity", "unit", "dissertation", "ours", "interval", "trials"}]}]
nlohmann::json to_json(const std::vector<Report>& reports);

/// \return one self-contained page: tables and inline SVG, no script.
std::string to_html(const std::vector<Report>& reports);

}  // namespace cgsr::lab
