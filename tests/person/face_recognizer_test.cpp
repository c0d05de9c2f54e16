#include <array>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/face/face_descriptor.h"
#include "pipeline/person/face/face_recognizer.h"

namespace cgsr::person {
namespace {

constexpr Box kFace{40, 40, 120, 120};

/// A texture of its own for each seed.
cv::Mat portrait(unsigned seed) {
  cv::RNG random(seed + 1);
  cv::Mat noise(20, 20, CV_8U), grey;
  random.fill(noise, cv::RNG::UNIFORM, 60, 200);
  cv::resize(noise, grey, {200, 200}, 0, 0, cv::INTER_CUBIC);
  return grey;
}

ImageView view_of_grey(const cv::Mat& grey) {
  return {grey.data, grey.cols, grey.rows, static_cast<std::ptrdiff_t>(grey.step), PixelFormat::kGrey8};
}

FaceGallery gallery_of_two() {
  FaceGallery gallery;
  for (const Label person : {1, 2}) {
    const auto face = describe_face(view_of_grey(portrait(static_cast<unsigned>(person))), kFace);
    for (int view = 0; view < 2; ++view) gallery.enroll(person, view_of(*face));
  }
  return gallery;
}

FaceGallery gallery_of_one() {
  FaceGallery gallery = gallery_of_two();
  gallery.forget(1);
  return gallery;
}

FaceQuestion question(std::uint32_t face, unsigned seed) {
  return {face, face_crop(view_of_grey(portrait(seed)), kFace)};
}

TEST(SteppedRecognizer, AnswersSoManyImagesAfterTheQuestionAndTakesOneAtATime) {
  SteppedRecognizer recognizer(FaceTrainer(gallery_of_two()), 3);
  EXPECT_FALSE(recognizer.answer());
  EXPECT_TRUE(recognizer.ask(question(7, 2)));
  EXPECT_FALSE(recognizer.ask(question(8, 1)));
  EXPECT_FALSE(recognizer.answer());
  EXPECT_FALSE(recognizer.answer());
  const auto answer = recognizer.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->face, 7U);
  EXPECT_EQ(answer->match.label, 2);
  EXPECT_FALSE(recognizer.answer());
  EXPECT_TRUE(recognizer.ask(question(8, 1)));
}

TEST(SteppedRecognizer, SaysAStrangersWhereTheCropIsNone) {
  SteppedRecognizer recognizer(FaceTrainer(gallery_of_two()), 1);
  EXPECT_TRUE(recognizer.ask({1, {}}));
  const auto answer = recognizer.answer();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->match.label, std::nullopt);
}

// The detector's box is a fifth too small or too large, and beside the face.
constexpr Box kRoughBoxes[] = {{52, 52, 96, 96}, {28, 28, 144, 144}, {56, 44, 100, 100}, {26, 34, 140, 140}};

TEST(IdentifyCrop, NamesAFaceWhoseBoxIsRough) {
  const FaceGallery gallery = gallery_of_two();
  for (const Box& box : kRoughBoxes) {
    for (const Label person : {1, 2}) {
      const GreyPatch crop = face_crop(view_of_grey(portrait(static_cast<unsigned>(person))), box);
      const FaceMatch match = identify_crop(crop, gallery);
      EXPECT_EQ(match.label, person) << box.x << ' ' << box.width << ", distance " << match.distance;
      EXPECT_LT(match.distance, 0.8 * gallery.identify(*describe_crop(crop)).distance) << box.x << ' ' << box.width;
    }
  }
}

// Everybody's face may be laid onto the enrolled ones: it does not become theirs.
TEST(IdentifyCrop, NamesNoStrangerWhateverHisBox) {
  const FaceGallery gallery = gallery_of_two();
  for (unsigned stranger = 100; stranger < 110; ++stranger) {
    EXPECT_FALSE(identify_crop(face_crop(view_of_grey(portrait(stranger)), kFace), gallery).label) << stranger;
    for (const Box& box : kRoughBoxes)
      EXPECT_FALSE(identify_crop(face_crop(view_of_grey(portrait(stranger)), box), gallery).label) << stranger;
  }
}

TEST(IdentifyCrop, IsTheGallerysAnswerWhereTheFaceLiesAsTheEnrolledOnes) {
  const FaceGallery one = gallery_of_one(), two = gallery_of_two();
  const GreyPatch crop = face_crop(view_of_grey(portrait(2)), kFace);
  const FaceMatch match = identify_crop(crop, one), at_once = one.identify(*describe_crop(crop));
  EXPECT_TRUE(at_once.alignment.is_small());
  EXPECT_EQ(match.label, at_once.label);
  EXPECT_EQ(match.distance, at_once.distance);
  EXPECT_EQ(identify_crop(crop, two).label, two.identify(*describe_crop(crop)).label);
  EXPECT_FALSE(identify_crop(crop, one, 2).label) << "left out";
}

/// The face of person 2, changed so far into another one's: as by a beard that grows.
FaceQuestion changed(std::uint32_t face, double share) {
  cv::Mat mixed;
  cv::addWeighted(portrait(2), 1.0 - share, portrait(50), share, 0.0, mixed);
  return {face, face_crop(view_of_grey(mixed), kFace)};
}

constexpr double kStep = 0.05, kFar = 0.4;

FaceTrainer trainer_with(const FaceMatchParameters& parameters = {}) {
  FaceGallery gallery(parameters);
  const FaceGallery two = gallery_of_two();
  for (const Label person : {1, 2}) {
    for (const FaceView& view : *two.views_of(person)) gallery.enroll(person, view);
  }
  return FaceTrainer(gallery);
}

/// Follows that face from how it was enrolled to what nobody was enrolled as. \return whose it is said to be then.
std::optional<Label> follow_change(FaceTrainer& trainer, std::uint32_t face) {
  for (int i = 0; i < 3; ++i) trainer.answer(changed(face, 0.0));
  std::optional<Label> last;
  for (double share = kStep; share < kFar + kStep / 2; share += kStep)
    last = trainer.answer(changed(face, share)).match.label;
  return last;
}

TEST(FaceTrainer, LearnsAFaceThatChangesWhileItIsFollowed) {
  FaceTrainer fixed = trainer_with({.max_learned_views = 0});
  EXPECT_FALSE(follow_change(fixed, 1)) << "changed so far that it is a stranger's";
  EXPECT_EQ(fixed.learned(1), 0U);

  FaceTrainer trainer = trainer_with();
  EXPECT_EQ(follow_change(trainer, 1), 2);
  EXPECT_GT(trainer.learned(1), 0U);
  EXPECT_FALSE(trainer.answer(changed(9, kFar)).match.label) << "what was learned of one face says nothing of another";
  EXPECT_EQ(trainer.answer(changed(1, kFar)).match.label, 2);
}

// What was learned of who was there says nothing of whoever comes before the face then.
TEST(FaceTrainer, ForgetsWhatItLearnedWhereSomebodyElseTakesTheFacesPlace) {
  FaceTrainer trainer = trainer_with();
  follow_change(trainer, 1);
  ASSERT_GT(trainer.learned(1), 0U);
  EXPECT_FALSE(trainer.answer(question(1, 100)).match.label);
  EXPECT_EQ(trainer.learned(1), 0U);
}

TEST(FaceTrainer, IsNotSureOfAStrangerWhoseFaceHardlyStandsOutOfTheNoise) {
  FaceTrainer trainer = trainer_with();
  double before = 1.0, others_before = 1.0;
  for (const double ratio : {kNoNoise, 3.5, 3.0, 2.5, 2.0}) {
    FaceQuestion stranger = question(1, 100), known = question(2, 1);
    stranger.signal_to_noise = known.signal_to_noise = ratio;
    const FaceMatch match = trainer.answer(stranger).match;
    EXPECT_FALSE(match.label);
    EXPECT_LE(match.confidence, before) << ratio;
    EXPECT_LE(match.rules_out, others_before) << ratio;
    before = match.confidence;
    others_before = match.rules_out;
    EXPECT_GT(trainer.answer(known).match.confidence, 0.75) << "a name is as sure as it is";
  }
  EXPECT_NEAR(before, 0.5, 1e-9);
  EXPECT_NEAR(others_before, 0.5, 1e-9);
}

TEST(FaceTrainer, KeepsWhoIsAskedForThoughOthersComeAndGo) {
  FaceTrainer trainer = trainer_with();
  follow_change(trainer, 1);
  ASSERT_GT(trainer.learned(1), 0U);
  for (std::uint32_t passer_by = 10; passer_by < 40; ++passer_by) {
    trainer.answer(question(passer_by, 100));
    trainer.answer(changed(1, kFar));
  }
  EXPECT_GT(trainer.learned(1), 0U);
}

TEST(FaceTrainer, KeepsAtMostSoManyLearnedViews) {
  FaceTrainer trainer = trainer_with({.max_learned_views = 1});
  follow_change(trainer, 1);
  EXPECT_EQ(trainer.learned(1), 1U);
}

// Whoever comes before the face of somebody who is followed is not learned as that person, though he be nearer to him than to everybody else.
TEST(FaceTrainer, LearnsNobodyWhoTakesTheFacesPlace) {
  FaceTrainer trainer = trainer_with(), careless = trainer_with({.max_step = 0.5});
  for (FaceTrainer* const one : {&trainer, &careless}) {
    for (int i = 0; i < 3; ++i) one->answer(changed(1, 0.0));
    const FaceMatch match = one->answer(changed(1, 0.35)).match;
    EXPECT_EQ(match.nearest, 2);
    EXPECT_GT(match.margin, 0.0);
  }
  EXPECT_EQ(trainer.learned(1), 0U);
  EXPECT_EQ(careless.learned(1), 1U) << "the step alone decides";
  for (unsigned stranger = 100; stranger < 110; ++stranger) trainer.answer(question(1, stranger));
  EXPECT_EQ(trainer.learned(1), 0U);
}

// The last face on the way that is still surely named, and the next one, which is not.
TEST(FaceTrainer, LearnsOnlyWhatIsTheSameTrackAndWasSurelyNamedTwice) {
  const FaceMatchParameters parameters;
  FaceTrainer fixed = trainer_with({.max_learned_views = 0});
  double sure = 0.0;
  while (fixed.answer(changed(1, sure + kStep)).match.margin >= 2.0 * parameters.min_margin) sure += kStep;
  const auto learned_after = [sure](int answers, std::uint32_t next_track) {
    FaceTrainer trainer = trainer_with();
    for (int i = 0; i < answers; ++i) trainer.answer(changed(1, sure));
    trainer.answer(changed(next_track, sure + kStep));
    return trainer.learned(next_track);
  };
  EXPECT_EQ(learned_after(2, 1), 1U);
  EXPECT_EQ(learned_after(1, 1), 0U) << "once is not enough";
  EXPECT_EQ(learned_after(2, 7), 0U) << "another face";
}

// What the fit says is what was done to the crop, and cutting it again undoes it.
TEST(FaceAlignment, IsWhereTheFaceLiesInItsCrop) {
  const FaceView view = view_of(*describe_face(view_of_grey(portrait(2)), kFace));
  std::array<double, kViewSide * kViewSide> distances{};
  const GreyPatch small = face_crop(view_of_grey(portrait(2)), {50, 50, 100, 100});
  const FaceAlignment found = view_distances(*describe_crop(small), view, distances);
  EXPECT_NEAR(found.a, 0.2, 0.04) << "the face is a fifth larger in the crop of a smaller box";
  EXPECT_NEAR(found.b, 0.0, 0.03);
  EXPECT_FALSE(found.is_small());
  const FaceAlignment again = view_distances(*describe_crop(aligned_crop(small, found)), view, distances);
  EXPECT_TRUE(again.is_small()) << again.a << ' ' << again.b << ' ' << again.dx_px << ' ' << again.dy_px;

  const GreyPatch beside = face_crop(view_of_grey(portrait(2)), {35, 44, 120, 120});
  const FaceAlignment moved = view_distances(*describe_crop(beside), view, distances);
  EXPECT_NEAR(moved.dx_px, 5.0 * 128 / 120, 1.5);
  EXPECT_NEAR(moved.dy_px, -4.0 * 128 / 120, 1.5);
  EXPECT_TRUE(aligned_crop({}, moved).pixels.empty());
}

TEST(FaceCrop, IsWhatTheFaceIsDescribedBy) {
  const cv::Mat image = portrait(3);
  const auto at_once = describe_face(view_of_grey(image), kFace);
  const auto later = describe_crop(face_crop(view_of_grey(image), kFace));
  ASSERT_TRUE(at_once && later);
  EXPECT_EQ(at_once->dense, later->dense);
  EXPECT_FALSE(describe_crop({}));
  EXPECT_FALSE(describe_crop({20, 20, std::vector<std::uint8_t>(400)}));
}

}  // namespace
}  // namespace cgsr::person
