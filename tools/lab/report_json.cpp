#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/parameters.h"
#include "tools/lab/report.h"

namespace cgsr::lab {
namespace {

using nlohmann::json;

constexpr std::array kJoins{
    std::pair(Join::kWeighted, std::string_view("weighted")), std::pair(Join::kMean, std::string_view("mean")),
    std::pair(Join::kShare, std::string_view("share")),       std::pair(Join::kMax, std::string_view("max")),
    std::pair(Join::kMin, std::string_view("min")),           std::pair(Join::kMedian, std::string_view("median")),
    std::pair(Join::kP95, std::string_view("p95")),           std::pair(Join::kPaired, std::string_view("paired")),
    std::pair(Join::kPairedP, std::string_view("paired p"))};

json rounded(const std::vector<double>& values) {
  auto array = json::array();
  for (const double value : values) array.push_back(stored_digits(value));
  return array;
}

json or_null(const std::optional<double>& value) {
  return value ? json(*value) : json();
}

constexpr std::array kKinds{Named<Requirement::Kind>{"at_most", Requirement::Kind::kAtMost},
                            Named<Requirement::Kind>{"at_least", Requirement::Kind::kAtLeast},
                            Named<Requirement::Kind>{"interval_within", Requirement::Kind::kIntervalWithin}};

json json_of(const Requirement& requirement) {
  json out = json::object();
  out[std::string(to_string(requirement.kind))] = requirement.bound;
  return out;
}

json json_of(const Row& row) {
  json out{{"row", row.row},
           {"quantity", row.quantity},
           {"unit", row.unit},
           {"dissertation", or_null(row.dissertation)},
           {"ours", or_null(row.ours)},
           {"interval", row.interval ? json{row.interval->low, row.interval->high} : json()},
           {"trials", row.trials},
           {"requirement", row.requirement ? json_of(*row.requirement) : json()},
           {"met", row.met() ? json(*row.met()) : json()},
           {"join", to_string(row.join)}};
  if (!row.samples.empty()) out["samples"] = rounded(row.samples);
  if (!row.weights.empty()) out["weights"] = rounded(row.weights);
  return out;
}

json json_of(const std::optional<Repetition>& repetition) {
  if (!repetition) return {};
  return {{"commit", repetition->commit}, {"trials", repetition->trials}, {"figures", repetition->figures}};
}

json json_without_rows(const Report& report) {
  auto runs = json::array();
  auto seeds = json::array();
  for (const Run& run : report.runs) {
    runs.push_back({{"seed", run.seed}, {"trials", run.trials}, {"commit", run.commit}});
    seeds.push_back(run.seed);
  }
  return {{"name", report.name},
          {"title", report.title},
          {"config_sha256", report.config_sha256},
          {"sources_sha256", report.sources_sha256},
          {"seed", report.seed},
          {"seeds", seeds},
          {"runs", runs},
          {"repetition", json_of(report.repetition)},
          {"notes", report.notes}};
}

std::optional<double> number_of(const json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<double>());
}

Row row_of(const json& in) {
  Row row;
  in.at("row").get_to(row.row);
  in.at("quantity").get_to(row.quantity);
  in.at("unit").get_to(row.unit);
  row.dissertation = number_of(in.at("dissertation"));
  row.ours = number_of(in.at("ours"));
  if (const auto& interval = in.at("interval"); !interval.is_null()) {
    row.interval = Interval{interval.at(0).get<double>(), interval.at(1).get<double>()};
  }
  in.at("trials").get_to(row.trials);
  if (const auto& required = in.at("requirement"); !required.is_null()) {
    for (const auto& [name, kind] : kKinds) {
      if (required.contains(name)) row.requirement = Requirement{required.at(name).get<double>(), kind};
    }
  }
  const auto word = in.at("join").get<std::string>();
  for (const auto& [join, name] : kJoins) {
    if (name == word) row.join = join;
  }
  if (in.contains("samples")) in.at("samples").get_to(row.samples);
  if (in.contains("weights")) in.at("weights").get_to(row.weights);
  return row;
}

Report report_of(const json& in) {
  Report report;
  in.at("name").get_to(report.name);
  in.at("title").get_to(report.title);
  in.at("config_sha256").get_to(report.config_sha256);
  in.at("sources_sha256").get_to(report.sources_sha256);
  in.at("seed").get_to(report.seed);
  in.at("notes").get_to(report.notes);
  for (const json& run : in.at("runs")) {
    report.runs.push_back(
        {run.at("seed").get<std::uint64_t>(), run.at("trials").get<int>(), run.at("commit").get<std::string>()});
  }
  if (in.contains("repetition") && !in.at("repetition").is_null()) {
    const json& repetition = in.at("repetition");
    report.repetition = Repetition{repetition.at("commit").get<std::string>(), repetition.at("trials").get<int>(),
                                   repetition.at("figures").get<int>()};
  }
  for (const json& row : in.at("rows")) report.rows.push_back(row_of(row));
  return report;
}

}  // namespace

// Six are more than any figure here is worth.
double stored_digits(double value) {
  const std::string digits = fmt::format("{:.6g}", value);
  double out = value;
  std::from_chars(digits.data(), digits.data() + digits.size(), out);
  return out;
}

std::string_view to_string(Requirement::Kind kind) {
  return word_in(kKinds, kind);
}

std::string_view to_string(Join join) {
  for (const auto& [value, name] : kJoins) {
    if (value == join) return name;
  }
  return "";
}

json to_json(const std::vector<Report>& reports) {
  auto all = json::array();
  for (const Report& report : reports) {
    json one = json_without_rows(report);
    one["rows"] = json::array();
    for (const Row& row : report.rows) one["rows"].push_back(json_of(row));
    all.push_back(std::move(one));
  }
  return all;
}

std::string to_json_text(const std::vector<Report>& reports) {
  std::string text = "[";
  for (const Report& report : reports) {
    text += text.size() > 1 ? ",\n{" : "\n{";
    const json head = json_without_rows(report);
    for (const auto& [key, value] : head.items()) text += fmt::format("\"{}\": {},\n", key, value.dump());
    text += "\"rows\": [";
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
      text += fmt::format("{}\n  {}", i == 0 ? "" : ",", json_of(report.rows[i]).dump());
    }
    text += "\n]}";
  }
  return text + "\n]\n";
}

Result<std::vector<Report>> reports_of(std::string_view text) {
  try {
    std::vector<Report> reports;
    for (const json& one : json::parse(text)) reports.push_back(report_of(one));
    return reports;
  } catch (const json::exception& error) {
    return fail(fmt::format("these are no results of cgsr reproduce: {}", error.what()));
  }
}

}  // namespace cgsr::lab
