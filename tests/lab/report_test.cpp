#include "tools/lab/report.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tools/lab/experiment.h"

namespace cgsr::lab {
namespace {

Report sample() {
  return {"name",
          "title <with> markup",
          "abc",
          7,
          {{"one", "IoU", "", std::nullopt, 0.5, Interval{0.4, 0.6}, 10},
           {"two", "mean", "Minstr", 47.6, std::nullopt, std::nullopt, 3}},
          {{"plot", "x", "y", {{"curve", {{0.0, 0.5, Interval{0.4, 0.6}}, {1.0, 0.7, std::nullopt}}}}}},
          {"a note"}};
}

// The shape that machines read; a key that changes breaks them, new ones are only added.
TEST(ReportJson, HasTheAgreedKeysAndNullWhereThereIsNothing) {
  const auto json = to_json({sample()}).at(0);

  EXPECT_EQ(json.at("name"), "name");
  EXPECT_EQ(json.at("config_sha256"), "abc");
  EXPECT_EQ(json.at("seed"), 7);
  const auto agreed = nlohmann::json::parse(R"([
    {"row": "one", "quantity": "IoU", "unit": "", "dissertation": null, "ours": 0.5, "interval": [0.4, 0.6], "trials": 10},
    {"row": "two", "quantity": "mean", "unit": "Minstr", "dissertation": 47.6, "ours": null, "interval": null, "trials": 3}])");
  for (std::size_t i = 0; i < agreed.size(); ++i) {
    for (const auto& [key, value] : agreed[i].items()) EXPECT_EQ(json.at("rows").at(i).at(key), value) << key;
  }
}

TEST(ReportJson, SaysWhatIsRequiredAndWhetherItIsMet) {
  Report report = sample();
  report.rows[0].requirement = Requirement{0.45, Requirement::Kind::kAtLeast};
  report.rows[1].requirement = Requirement{5.0};

  const auto rows = to_json({report}).at(0).at("rows");

  EXPECT_EQ(rows[0].at("requirement"), nlohmann::json::parse(R"({"at_least": 0.45})"));
  EXPECT_EQ(rows[0].at("met"), true);
  EXPECT_EQ(rows[1].at("requirement"), nlohmann::json::parse(R"({"at_most": 5.0})"));
  EXPECT_TRUE(rows[1].at("met").is_null()) << "nothing was measured";
}

TEST(ReportText, SaysLoudlyWhatIsNotMet) {
  Report report = sample();
  report.rows[0].requirement = Requirement{0.9, Requirement::Kind::kAtLeast};

  EXPECT_NE(to_text(report).find("[required at least 0.9, NOT MET]"), std::string::npos) << to_text(report);
}

TEST(ReportText, PutsWhatWasMeasuredDownAndTheQuantitiesAcross) {
  const std::string text = to_text(sample());

  EXPECT_NE(text.find("0.500 0.400..0.600"), std::string::npos) << text;
  EXPECT_NE(text.find("mean [Minstr]"), std::string::npos) << text;
  EXPECT_NE(text.find("not there (dissertation 47.6)"), std::string::npos) << text;
}

TEST(ReportHtml, IsOnePageWithoutScriptAndWithMarkupEscaped) {
  const std::string html = to_html({sample()});

  EXPECT_NE(html.find("title &lt;with&gt; markup"), std::string::npos);
  EXPECT_NE(html.find("<polyline"), std::string::npos);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

Report sample_with_stripe() {
  Report report = sample();
  report.stripes = {{"light",
                     {{"estimated", {color::Light{1.0, 0.8, 0.6}, std::nullopt}},
                      {"true", {color::Light{0.9, 0.8, 0.7}, color::Light{0.6, 0.7, 0.8}}}}}};
  return report;
}

TEST(Stripe, StandsInTheTextStepByStepWithNoneWhereNothingWasSeen) {
  const std::string text = to_text(sample_with_stripe());

  EXPECT_NE(text.find("0  1.00 0.80 0.60      0.90 0.80 0.70"), std::string::npos) << text;
  EXPECT_NE(text.find("1  none                0.60 0.70 0.80"), std::string::npos) << text;
}

TEST(Stripe, IsDrawnAsItsColorsAndLeavesAGapWhereNothingWasSeen) {
  const std::string html = to_html({sample_with_stripe()});

  EXPECT_NE(html.find("rgb(100.0%,80.0%,60.0%)"), std::string::npos);
  EXPECT_NE(html.find("rgb(60.0%,70.0%,80.0%)"), std::string::npos);
  std::size_t colors = 0;
  for (auto at = html.find("rgb("); at != std::string::npos; at = html.find("rgb(", at + 1)) ++colors;
  EXPECT_EQ(colors, 3U);
}

// RFC 4648, section 10: "foobar".
TEST(Picture, LiesInThePageItself) {
  Report report = sample();
  report.pictures = {{"what <is> seen", {'f', 'o', 'o', 'b', 'a', 'r'}}};

  const std::string html = to_html({report});

  EXPECT_NE(html.find("base64,Zm9vYmFy\""), std::string::npos);
  EXPECT_NE(html.find("what &lt;is&gt; seen"), std::string::npos);
}

TEST(MeanRow, SharesThatAreAllZeroStillHaveAnUpperBound) {
  const Row row = mean_row("r", "precision", "", std::vector<double>(20, 0.0), 1);

  ASSERT_TRUE(row.interval);
  EXPECT_NEAR(row.interval->high, 0.161, 1e-3);
}

TEST(Experiment, HashesTheSectionsThatItMeasuresWith) {
  Setting setting;
  const auto shipped = experiment_of("light-sweep")->config_sha256(setting);
  const auto lamp = experiment_of("table-5.1")->config_sha256(setting);
  setting.configuration.learn.lights.min_level = 0.5;

  ASSERT_TRUE(shipped);
  ASSERT_TRUE(lamp);
  EXPECT_EQ(shipped->size(), 64U);
  EXPECT_NE(*experiment_of("light-sweep")->config_sha256(setting), *shipped);
  EXPECT_EQ(*experiment_of("table-5.1")->config_sha256(setting), *lamp) << "it does not use [color]";
}

}  // namespace
}  // namespace cgsr::lab
