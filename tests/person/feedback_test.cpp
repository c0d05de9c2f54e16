#include "pipeline/person/feedback.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace cgsr::person {
namespace {

constexpr std::optional<Classification> kNothing;

/// A branch of Alg. 6.1: what the two answered, and what must come of it.
struct Branch {
  const char* lines;
  std::optional<Classification> primary;
  std::optional<Classification> secondary;
  std::optional<Label> expected;
  bool trains_primary;
  bool trains_secondary;
};

const std::vector<Branch> kBranches{
    {"nobody answers", kNothing, kNothing, std::nullopt, false, false},
    {"26: the secondary alone", kNothing, Classification{2, 0.3}, 2, false, false},
    {"22: the primary alone teaches the secondary", Classification{1, 0.3}, kNothing, 1, false, true},
    {"14: both agree", Classification{1, 0.2}, Classification{1, 0.9}, 1, false, false},
    {"16: the primary is surer", Classification{1, 0.8}, Classification{2, 0.7}, 1, false, true},
    {"18: the secondary is surer", Classification{1, 0.6}, Classification{2, 0.7}, 2, true, false},
    {"15: as sure as each other, which is not more", Classification{1, 0.7}, Classification{2, 0.7}, 2, true, false},
};

TEST(Feedback, EveryBranchOfTheAlgorithm) {
  for (const Branch& branch : kBranches) {
    SCOPED_TRACE(branch.lines);
    std::vector<FeedbackMember> members{{.level = 0, .answer = branch.primary},
                                        {.level = 1, .answer = branch.secondary}};
    const auto settled = settle(members);
    EXPECT_EQ(settled ? std::optional(settled->label) : std::nullopt, branch.expected);
    EXPECT_EQ(members[0].trained, branch.trains_primary);
    EXPECT_EQ(members[1].trained, branch.trains_secondary);
  }
}

TEST(Feedback, APrimaryThatWasNotRequiredIsNotTrained) {
  std::vector<FeedbackMember> members{{.level = 0, .required = false}, {.level = 1, .answer = Classification{2, 0.9}}};
  EXPECT_EQ(settle(members)->label, 2);
  EXPECT_FALSE(members[0].trained);
}

TEST(Feedback, SecondariesTeachEachOtherWhenThePrimaryIsSilent) {
  std::vector<FeedbackMember> members{{.level = 0},
                                      {.level = 1, .answer = Classification{1, 0.4}},
                                      {.level = 1, .answer = Classification{2, 0.6}},
                                      {.level = 1}};
  EXPECT_EQ(settle(members)->label, 2);
  EXPECT_FALSE(members[0].trained) << "what it would be trained with is not there";
  EXPECT_TRUE(members[1].trained);
  EXPECT_FALSE(members[2].trained);
  EXPECT_FALSE(members[3].trained) << "nobody above it decided";
}

TEST(Feedback, AThirdLevelLearnsFromTheSecond) {
  std::vector<FeedbackMember> members{{.level = 0}, {.level = 1, .answer = Classification{1, 0.4}}, {.level = 2}};
  EXPECT_EQ(settle(members)->label, 1);
  EXPECT_TRUE(members[2].trained);
}

/// Answers what it is told to, and writes down how it was trained.
class Scripted : public Classifier<int> {
 public:
  explicit Scripted(std::optional<Classification> answer) : answer_(answer) {}
  std::optional<Classification> classify(const int& input) override {
    log += "classify " + std::to_string(input) + ";";
    return answer_;
  }
  void train(Label label, std::optional<Label> mistaken_for) override {
    log += "train " + std::to_string(label) + (mistaken_for ? " not " + std::to_string(*mistaken_for) : "") + ";";
  }
  std::string log;

 private:
  std::optional<Classification> answer_;
};

TEST(FeedbackClassifier, TrainsWithTheInputThatWasClassified) {
  Scripted primary(Classification{1, 0.9});
  Scripted wrong(Classification{2, 0.5});
  Scripted blind(std::nullopt);
  FeedbackClassifier<int> classifier;
  classifier.add(primary, 0);
  classifier.add(wrong, 1);
  classifier.add(blind, 1);

  EXPECT_EQ(classifier.classify(7)->label, 1);

  EXPECT_EQ(primary.log, "classify 7;");
  EXPECT_EQ(wrong.log, "classify 7;train 1 not 2;");
  EXPECT_EQ(blind.log, "classify 7;train 1;");
}

TEST(FeedbackClassifier, ReliabilityShiftsWhoIsBelieved) {
  Scripted face(Classification{1, 0.8});
  Scripted shirt(Classification{2, 0.6});
  FeedbackClassifier<int> classifier;
  const auto grey = classifier.add(face, 0);
  classifier.add(shirt, 1);
  EXPECT_EQ(classifier.classify(0)->label, 1);

  classifier.rely(grey, 0.5);  // the image is blurred

  EXPECT_EQ(classifier.classify(1)->label, 2);
  EXPECT_EQ(face.log, "classify 0;classify 1;train 2 not 1;");
}

TEST(FeedbackClassifier, WhoIsNotRequiredDoesNothing) {
  Scripted face(Classification{1, 0.8});
  Scripted shirt(Classification{2, 0.6});
  FeedbackClassifier<int> classifier;
  const auto primary = classifier.add(face, 0);
  classifier.add(shirt, 1);
  classifier.require(primary, false);
  EXPECT_EQ(classifier.classify(0)->label, 2);
  EXPECT_EQ(face.log, "");
}

}  // namespace
}  // namespace cgsr::person
