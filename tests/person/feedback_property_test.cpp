// Labels converge to the truth when the primary is right more often than wrong and its confidence says so; and not otherwise.
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/person/feedback.h"

namespace cgsr::person {
namespace {

constexpr int kClasses = 4;

/// What is looked at: the true class, and what the secondary sees of it. Each class has an appearance of its own.
struct Sight {
  Label truth = 0;
  std::size_t appearance = 0;
};

/// A primary that is right with a given probability and sees nothing in a third of the images.
class NoisyPrimary : public Classifier<Sight> {
 public:
  struct Quality {
    double right = 0.7;
    std::array<double, 2> confidence_when_right{0.5, 0.95};
    std::array<double, 2> confidence_when_wrong{0.2, 0.6};
  };
  NoisyPrimary(const Quality& quality, std::uint64_t seed) : quality_(quality), random_(seed) {}

  std::optional<Classification> classify(const Sight& sight) override {
    if (unit_(random_) < 1.0 / 3.0) return std::nullopt;
    const bool right = unit_(random_) < quality_.right;
    const auto& [low, high] = right ? quality_.confidence_when_right : quality_.confidence_when_wrong;
    const double confidence = low + (high - low) * unit_(random_);
    const Label other = (sight.truth + 1 + static_cast<Label>(unit_(random_) * (kClasses - 1))) % kClasses;
    return Classification{right ? sight.truth : other, confidence};
  }
  void train(Label /*label*/, std::optional<Label> /*mistaken_for*/) override {}

 private:
  Quality quality_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

/// A table from appearance to the class that was taught last; it knows nothing at first, and is always equally sure.
class TableSecondary : public Classifier<Sight> {
 public:
  explicit TableSecondary(double confidence) : confidence_(confidence) {}

  std::optional<Classification> classify(const Sight& sight) override {
    last_ = sight.appearance;
    return answer(sight.appearance);
  }
  void train(Label label, std::optional<Label> /*mistaken_for*/) override { taught_[last_] = label; }
  [[nodiscard]] std::optional<Classification> answer(std::size_t appearance) const {
    if (!taught_[appearance]) return std::nullopt;
    return Classification{*taught_[appearance], confidence_};
  }

 private:
  double confidence_;
  std::array<std::optional<Label>, kClasses> taught_{};
  std::size_t last_ = 0;
};

/// \return the share of appearances that the secondary has learned rightly after so many images.
double learned_rightly(const NoisyPrimary::Quality& quality, double secondary_confidence, std::uint64_t seed,
                       int images) {
  NoisyPrimary primary(quality, seed);
  TableSecondary secondary(secondary_confidence);
  FeedbackClassifier<Sight> classifier;
  classifier.add(primary, 0);
  classifier.add(secondary, 1);
  std::mt19937_64 random(seed ^ 0x9e3779b97f4a7c15U);
  std::uniform_int_distribution<Label> any(0, kClasses - 1);
  for (int i = 0; i < images; ++i) {
    const Label truth = any(random);
    classifier.classify({truth, static_cast<std::size_t>(truth)});
  }
  int right = 0;
  for (Label label = 0; label < kClasses; ++label) {
    const auto answer = secondary.answer(static_cast<std::size_t>(label));
    right += answer && answer->label == label ? 1 : 0;
  }
  return static_cast<double>(right) / kClasses;
}

double mean_over_seeds(const NoisyPrimary::Quality& quality, double secondary_confidence, int images) {
  double sum = 0.0;
  constexpr int kSeeds = 200;
  for (int seed = 1; seed <= kSeeds; ++seed)
    sum += learned_rightly(quality, secondary_confidence, static_cast<std::uint64_t>(seed), images);
  return sum / kSeeds;
}

// Whoever is wrong is never as sure as the secondary; whoever is right sometimes is surer.
TEST(FeedbackProperty, LabelsConvergeWhenThePrimaryIsMostlyRightAndKnowsIt) {
  std::mt19937_64 random(20261124);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    const double secondary = 0.5 + 0.3 * unit(random);
    const NoisyPrimary::Quality quality{.right = 0.55 + 0.4 * unit(random),
                                        .confidence_when_right = {0.4, secondary + 0.15},
                                        .confidence_when_wrong = {0.1, secondary - 0.01}};
    const double early = mean_over_seeds(quality, secondary, 6);
    const double late = mean_over_seeds(quality, secondary, 600);
    EXPECT_GT(late, 0.999) << trial;
    EXPECT_LT(early, late - 0.05) << trial << ": they were learned, not known";
  }
}

TEST(FeedbackProperty, APrimaryThatIsSurerWhenWrongTeachesWrongLabels) {
  const NoisyPrimary::Quality misleading{
      .right = 0.7, .confidence_when_right = {0.2, 0.4}, .confidence_when_wrong = {0.8, 1.0}};
  EXPECT_LT(mean_over_seeds(misleading, 0.6, 600), 0.1) << "right more often than wrong is not enough";
}

TEST(FeedbackProperty, WithoutConfidenceLabelsFollowThePrimaryOnly) {
  const NoisyPrimary::Quality level{
      .right = 0.7, .confidence_when_right = {0.9, 0.9}, .confidence_when_wrong = {0.9, 0.9}};
  EXPECT_NEAR(mean_over_seeds(level, 0.6, 600), 0.7, 0.05);
}

}  // namespace
}  // namespace cgsr::person
