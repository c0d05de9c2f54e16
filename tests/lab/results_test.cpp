#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"
#include "tools/lab/join.h"
#include "tools/lab/page.h"
#include "tools/lab/repeat.h"
#include "tools/lab/sources.h"
#include "tools/lab/store.h"
#include "tools/lab/tables/requirements.h"

namespace cgsr::lab {
namespace {

Report run_of(std::uint64_t seed, std::vector<double> errors, int found, int of, double worst) {
  Report report;
  report.name = "table-4.1";
  report.title = "poses";
  report.config_sha256 = std::string(64, 'c');
  report.sources_sha256 = std::string(64, 's');
  report.seed = seed;
  report.runs = {{seed, of, "0123456789ab"}};
  report.rows = {mean_row("ours", "position error", "cm", errors, seed), share_row("ours", "corrected", found, of),
                 plain_row("cost", "worst", "Minstr", worst, static_cast<std::size_t>(of), Join::kMax),
                 plain_row("cost", "mean", "Minstr", worst / 2.0, static_cast<std::size_t>(of)),
                 sampled_row("ours", "median error", "cm", errors, Join::kMedian, seed)};
  report.rows[0].requirement = Requirement{2.5};
  report.rows[0].dissertation = 8.02;
  return report;
}

// Joined are the trials, not the figures: as if one run had made them all.
TEST(Joined, GivesTheFiguresOfAllTrialsTogether) {
  const auto both = joined(run_of(1001, {1.0, 2.0}, 1, 2, 8.0), run_of(1002, {3.0, 3.0, 6.0}, 3, 3, 6.0));

  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->runs.size(), 2U);
  EXPECT_EQ(both->rows[0].trials, 5);
  EXPECT_DOUBLE_EQ(*both->rows[0].ours, 3.0);
  EXPECT_TRUE(both->rows[0].interval);
  EXPECT_DOUBLE_EQ(*both->rows[1].ours, 4.0 / 5.0);
  EXPECT_DOUBLE_EQ(*both->rows[2].ours, 8.0);
  EXPECT_DOUBLE_EQ(*both->rows[3].ours, (2 * 4.0 + 3 * 3.0) / 5.0);
  EXPECT_DOUBLE_EQ(*both->rows[4].ours, 3.0);
  EXPECT_EQ(both->rows[0].requirement->bound, 2.5);
  EXPECT_EQ(both->rows[0].dissertation, 8.02);
}

// Runs may come in any order and in any parts.
TEST(Joined, IsTheSameInWhateverOrder) {
  const Report a = run_of(1001, {1.0, 2.0}, 1, 2, 8.0);
  const Report b = run_of(1002, {3.0, 5.0}, 2, 2, 6.0);
  const Report c = run_of(1003, {4.0}, 0, 1, 9.0);

  const auto left = joined(*joined(a, b), c);
  const auto right = joined(a, *joined(c, b));

  ASSERT_TRUE(left);
  ASSERT_TRUE(right);
  for (std::size_t i = 0; i < left->rows.size(); ++i) {
    EXPECT_NEAR(*left->rows[i].ours, *right->rows[i].ours, 1e-12) << left->rows[i].row;
    EXPECT_EQ(left->rows[i].trials, right->rows[i].trials);
  }
}

TEST(Joined, RefusesWhatWasNotMeasuredAlike) {
  const Report a = run_of(1001, {1.0}, 1, 1, 8.0);
  Report other_sources = run_of(1002, {1.0}, 1, 1, 8.0);
  other_sources.sources_sha256 = std::string(64, 't');
  Report other_configuration = run_of(1002, {1.0}, 1, 1, 8.0);
  other_configuration.config_sha256 = std::string(64, 'd');

  EXPECT_FALSE(joined(a, other_sources));
  EXPECT_FALSE(joined(a, other_configuration));
  EXPECT_FALSE(joined(a, a)) << "the same trials twice";
}

Report at_new_sources(Report report) {
  report.sources_sha256 = std::string(64, 'n');
  report.runs[0].commit = "ba9876543210";
  return report;
}

// A change that moves none of the trials that were measured again is one that the table does not measure.
TEST(Repeated, TakesTheNewSourcesWhereTheFirstTrialsAreTheSame) {
  const Report stored = *joined(run_of(1001, {1.0, 2.0, 5.0}, 2, 3, 8.0), run_of(1002, {3.0}, 1, 1, 9.0));

  const auto both = repeated(stored, at_new_sources(run_of(1001, {1.0, 2.0}, 2, 2, 4.0)));

  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->sources_sha256, std::string(64, 'n'));
  EXPECT_EQ(both->rows[0].samples, stored.rows[0].samples) << "the figures are those of before";
  ASSERT_TRUE(both->repetition);
  EXPECT_EQ(both->repetition->trials, 2);
  EXPECT_EQ(both->repetition->figures, 4) << "errors and their median; cost and shares of fewer trials say nothing";
  EXPECT_EQ(both->repetition->commit, "ba9876543210");
  EXPECT_EQ(reports_of(to_json_text({*both})).value().front().repetition->trials, 2);
}

TEST(Repeated, NamesTheFirstFigureThatDiffers) {
  const Report stored = run_of(1001, {1.0, 2.0, 5.0}, 2, 3, 8.0);

  const auto other = repeated(stored, at_new_sources(run_of(1001, {1.0, 2.5}, 2, 2, 4.0)));
  const auto longer = repeated(stored, at_new_sources(run_of(1001, {1.0, 2.0, 5.0, 6.0}, 2, 3, 8.0)));
  const auto fewer_found = repeated(stored, at_new_sources(run_of(1001, {1.0, 2.0, 5.0}, 1, 3, 8.0)));

  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().message, "table-4.1: 'ours: position error', sample 1: 2.5 now, 2 before");
  EXPECT_FALSE(longer);
  ASSERT_FALSE(fewer_found) << "of all trials shares are compared too";
  EXPECT_NE(fewer_found.error().message.find("'ours: corrected'"), std::string::npos);
}

TEST(Repeated, RefusesOtherTrialsAndWhatHasNothingToCompare) {
  const Report stored = run_of(1001, {1.0, 2.0}, 2, 2, 8.0);
  Report without_samples = stored;
  without_samples.rows = {stored.rows[1]};
  Report shares = run_of(1001, {1.0}, 1, 1, 8.0);
  shares.rows = {shares.rows[1]};

  EXPECT_FALSE(repeated(stored, at_new_sources(run_of(1002, {1.0}, 1, 1, 8.0)))) << "another seed";
  EXPECT_FALSE(repeated(stored, at_new_sources(run_of(1001, {1.0, 2.0, 3.0}, 2, 3, 8.0)))) << "more trials";
  EXPECT_FALSE(repeated(without_samples, at_new_sources(shares)));
}

TEST(Store, GivesBackWhatWasPutIn) {
  const test::ScratchFolder folder;
  const Store store(folder / "results");
  const Report report = run_of(1001, {1.0, 2.5}, 1, 2, 8.0);

  ASSERT_TRUE(store.write(report));
  const auto read = store.read("table-4.1");

  ASSERT_TRUE(read) << read.error().message;
  ASSERT_TRUE(*read);
  EXPECT_EQ(to_json_text({**read}), to_json_text({report}));
  EXPECT_FALSE(*store.read("table-5.1")) << "nothing is stored of it";
}

// What was tuned on a seed is not shown on it.
TEST(Store, RefusesSeedsOfTestsAndTuning) {
  const test::ScratchFolder folder;

  const auto written = Store(folder / "results").write(run_of(7, {1.0}, 1, 1, 8.0));

  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("seed 7"), std::string::npos);
  EXPECT_GE(draw_seed(), kMinDrawnSeed);
  EXPECT_NE(draw_seed(), draw_seed());
}

TEST(Store, NamesTheFileThatIsDamaged) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "table-4.1.json") << "[{\"name\": \"table-4.1\"}]";

  const auto read = Store(folder / "").read("table-4.1");

  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("table-4.1.json"), std::string::npos);
}

TEST(Sources, HaveTheSameHashUntilCodeChanges) {
  const test::ScratchFolder folder;
  const auto write = [&](const std::string& text) { std::ofstream(folder / "room.cpp") << text; };
  const std::array<std::string_view, 1> paths{"room.cpp"};
  const auto hash = [&] { return sources_sha256(folder / "", paths).value(); };
  write("int f() { return 1; }  // one\n");
  const std::string before = hash();

  write("/* says more */\nint f() {\n  return 1;\n}\n");
  EXPECT_EQ(hash(), before) << "a comment and a line break are no change";
  write("int f() { return 2; }\n");
  EXPECT_NE(hash(), before);
}

TEST(Sources, KeepLiteralsThatLookLikeComments) {
  EXPECT_EQ(without_comments("a = \"// b\";  // c"), "a = \"// b\"; ");
  EXPECT_EQ(without_comments("x = '\"'; // c"), "x = '\"'; ");
  EXPECT_EQ(without_comments("n = 1'000; /* c */ m"), "n = 1'000; m");
}

TEST(Sources, ComplainOfARoomThatIsNotThere) {
  const std::array<std::string_view, 1> paths{"pipeline/nowhere"};

  EXPECT_FALSE(sources_sha256(".", paths));
}

TEST(Experiments, NameRoomsThatAreThereAndStoreNothingUnderASharedName) {
  for (const Experiment& experiment : experiments()) {
    const auto staleness = staleness_of(run_of(1001, {1.0}, 1, 1, 8.0), experiment);
    EXPECT_TRUE(staleness) << experiment.name << ": " << staleness.error().message;
    EXPECT_GT(experiment.trials, 0);
  }
  for (const NamedRequirement& required : requirements()) {
    EXPECT_NE(experiment_of(required.table), nullptr) << required.table;
  }
}

std::vector<PageEntry> entries_with(Staleness staleness) {
  return {{experiment_of("table-4.1"), run_of(1001, {1.0, 2.0}, 1, 2, 8.0), staleness},
          {experiment_of("table-5.1"), std::nullopt, Staleness::kFresh}};
}

TEST(Page, HasATablePerChapterWithWhatIsRequiredAndMet) {
  const std::string page = page_of(entries_with(Staleness::kFresh));

  EXPECT_NE(page.find("## Chapter 4"), std::string::npos);
  EXPECT_NE(page.find("| ours: position error [cm] | 8.020 | 1.500 (1.000 to 2.000) | at most 2.5 | yes | "
                      "`cgsr reproduce table-4.1` |"),
            std::string::npos)
      << page;
  EXPECT_NE(page.find("not measured on this tree"), std::string::npos);
  EXPECT_EQ(page.find("worst"), std::string::npos) << "nothing is required of it: it stands in the JSON alone";
  EXPECT_NE(page.find("seed 1001"), std::string::npos);
}

TEST(Page, MarksWhatIsStaleAndIsOtherwiseTheSame) {
  const std::string fresh = page_of(entries_with(Staleness::kFresh));
  const std::string stale = page_of(entries_with(Staleness::kSources));

  EXPECT_NE(stale.find("| yes (stale) |"), std::string::npos) << stale;
  EXPECT_NE(stale.find("(stale: sources changed)"), std::string::npos);
  EXPECT_EQ(without_stale_marks(stale), fresh);
  EXPECT_EQ(fresh.find("(stale"), std::string::npos);
}

TEST(Page, SaysWhatWasRepeated) {
  auto entries = entries_with(Staleness::kFresh);
  entries[0].stored->repetition = Repetition{"ba9876543210", 6, 240};

  EXPECT_NE(page_of(entries).find("its first 6 trials, repeated at commit ba9876543210, gave the same 240 figures"),
            std::string::npos);
}

TEST(Page, SaysWhyARequirementIsNotMetWhereThatIsKnown) {
  auto entries = entries_with(Staleness::kFresh);
  std::vector<Row>& rows = entries[0].stored->rows;
  rows[0].requirement = Requirement{1.0};                               // of 1.5 cm
  rows[1].requirement = Requirement{0.9, Requirement::Kind::kAtLeast};  // of a half
  const std::string page = page_of(entries);

  EXPECT_NE(page.find("not met: ours, corrected: the gate, "), std::string::npos) << page;
  EXPECT_NE(page.find("not met: ours, position error: the cause is not known"), std::string::npos);
}

TEST(Staleness, SaysWhatChanged) {
  const Experiment& experiment = *experiment_of("table-4.1");
  Report report = run_of(1001, {1.0}, 1, 1, 8.0);

  EXPECT_EQ(staleness_of(report, experiment).value(), Staleness::kConfiguration);
  report.config_sha256 = experiment.config_sha256({}).value();
  EXPECT_EQ(staleness_of(report, experiment).value(), Staleness::kSources);
}

}  // namespace
}  // namespace cgsr::lab
