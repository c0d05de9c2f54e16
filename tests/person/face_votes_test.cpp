// Whose one face is, by several comparisons.

#include <optional>

#include <gtest/gtest.h>

#include "pipeline/person/face/face_votes.h"

namespace cgsr::person {
namespace {

FaceMatch answer(std::optional<Label> label, double confidence) {
  FaceMatch match;
  match.label = label;
  match.confidence = confidence;
  return match;
}

FaceVotes votes(int count, std::optional<Label> label, double confidence) {
  FaceVotes all;
  for (int i = 0; i < count; ++i) all.add(answer(label, confidence), 2);
  return all;
}

TEST(FaceVotes, OneAnswerIsNone) {
  EXPECT_FALSE(votes(1, 4, 0.9).match());
  FaceVotes alone;
  alone.add(answer(4, 0.8), 1);
  ASSERT_TRUE(alone.match());
  EXPECT_NEAR(alone.match()->confidence, 0.8, 1e-12) << "of a single comparison it is its own";
}

TEST(FaceVotesProperty, MoreComparisonsAreSurerUpToABound) {
  for (const double each : {0.56, 0.62, 0.9}) {
    double before = each;
    for (int count = 2; count <= 16; ++count) {
      const double now = votes(count, std::nullopt, each).match()->confidence;
      EXPECT_GE(now, before);
      before = now;
    }
    EXPECT_DOUBLE_EQ(votes(40, std::nullopt, each).match()->confidence, before);
    EXPECT_LT(before, 1.0);
  }
  EXPECT_DOUBLE_EQ(votes(16, 4, 0.5).match()->confidence, 0.5) << "at the threshold nothing is learned from many";
}

TEST(FaceVotes, AtTheThresholdNobodyBecomesAStranger) {
  FaceVotes votes_at_it = votes(16, std::nullopt, 0.54);
  EXPECT_FALSE(votes_at_it.match());
  votes_at_it.add(answer(4, 0.54), 2);
  for (int i = 0; i < 3; ++i) votes_at_it.add(answer(std::nullopt, 0.5), 2);
  votes_at_it.add(answer(4, 0.54), 2);
  EXPECT_FALSE(votes_at_it.match()) << "two of the last three have to agree";
  votes_at_it.add(answer(4, 0.54), 2);
  ASSERT_TRUE(votes_at_it.match());
  EXPECT_EQ(votes_at_it.match()->label, 4);
}

TEST(FaceVotes, AStrangerNearTheThresholdBecomesSurerThanAShirt) {
  EXPECT_LT(votes(2, std::nullopt, 0.62).match()->confidence, 0.7);
  EXPECT_GT(votes(6, std::nullopt, 0.62).match()->confidence, 0.7);
}

TEST(FaceVotes, AContradictionIsNoNameAndMakesLessSure) {
  FaceVotes face = votes(10, 4, 0.7);
  const double before = face.match()->confidence;
  EXPECT_FALSE(face.contradicted());
  face.add(answer(std::nullopt, 0.7), 2);
  EXPECT_TRUE(face.contradicted());
  EXPECT_EQ(face.match()->label, 4);
  EXPECT_LT(face.match()->confidence, before);
  face.add(answer(4, 0.7), 2);
  EXPECT_FALSE(face.contradicted());
  EXPECT_GT(face.match()->confidence, 0.7) << "one outlier does not take all of it";
}

TEST(FaceVotes, TwoThatAgreeGiveAnotherNameAndBeginAnew) {
  FaceVotes face = votes(16, 4, 0.9);
  face.add(answer(7, 0.6), 2);
  face.add(answer(7, 0.6), 2);
  EXPECT_EQ(face.match()->label, 7);
  EXPECT_DOUBLE_EQ(face.match()->confidence, votes(2, 7, 0.6).match()->confidence);
}

// A face that was sure and is near the threshold now does not stay sure.
TEST(FaceVotes, WhatWasSeenLongAgoFades) {
  FaceVotes face = votes(16, 4, 0.95);
  for (int i = 0; i < 100; ++i) face.add(answer(4, 0.52), 2);
  EXPECT_NEAR(face.match()->confidence, votes(16, 4, 0.52).match()->confidence, 0.01);
}

// Who is nearest to one person in both comparisons is no other; where the nearest changes nobody is ruled out.
TEST(FaceVotes, RuleOutOthersAsSurelyAsTheLeastSure) {
  const auto like = [](Label nearest, double rules_out) {
    FaceMatch match = answer(std::nullopt, 0.55);
    match.nearest = nearest;
    match.rules_out = rules_out;
    return match;
  };
  FaceVotes face;
  face.add(like(2, 0.9), 2);
  EXPECT_FALSE(face.match());
  face.add(like(2, 0.85), 2);
  ASSERT_TRUE(face.match());
  EXPECT_DOUBLE_EQ(face.match()->rules_out, 0.85);
  face.add(like(1, 0.95), 2);
  EXPECT_DOUBLE_EQ(face.match()->rules_out, 0.0);
  face.add(like(1, 0.95), 2);
  face.add(like(1, 0.83), 2);
  EXPECT_DOUBLE_EQ(face.match()->rules_out, 0.83) << "of the last three";
  for (const double confidence : {0.52, 0.7}) {
    FaceVotes contradicted;
    for (int i = 0; i < 2; ++i) contradicted.add(like(2, 0.9), 2);
    FaceMatch other = answer(1, confidence);
    other.nearest = 1;
    contradicted.add(other, 2);
    EXPECT_EQ(contradicted.match()->label, std::nullopt);
    EXPECT_DOUBLE_EQ(contradicted.match()->rules_out, 0.0) << confidence;
  }
}

// A face that is as far as the threshold: it keeps the name that it has until one is clearly wrong.
TEST(FaceVotes, AreNotContradictedAtTheThreshold) {
  for (const std::optional<Label> first : {std::optional<Label>(1), std::optional<Label>()}) {
    const std::optional<Label> other = first ? std::nullopt : std::optional<Label>(1);
    FaceVotes face = votes(2, first, 0.56);
    const double before = face.match()->confidence;
    for (int i = 0; i < 10; ++i) face.add(answer(other, 0.54), 2);
    EXPECT_EQ(face.match()->label, first);
    EXPECT_FALSE(face.contradicted());
    EXPECT_DOUBLE_EQ(face.match()->confidence, before);
    face.add(answer(other, 0.6), 2);
    face.add(answer(other, 0.6), 2);
    EXPECT_EQ(face.match()->label, other);
  }
}

}  // namespace
}  // namespace cgsr::person
