// Relit films, films without the object, folds, and what is kept of runs.

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "tests/support/real_data.h"
#include "tests/support/scratch_folder.h"
#include "tools/lab/scenes/random.h"
#include "tools/lab/tracking/choices.h"
#include "tools/lab/tracking/folds.h"
#include "tools/lab/tracking/painted_over.h"
#include "tools/lab/tracking/relight.h"
#include "tools/lab/tracking/runs.h"
#include "tools/lab/tracking/sequences.h"

namespace cgsr::lab {
namespace {

constexpr int kWidth = 160, kHeight = 120;

Film gray_film(int images, int level) {
  std::vector<Image> all;
  for (int i = 0; i < images; ++i) {
    all.push_back(image_of_bgr(cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(level, level, level))));
  }
  return film_of_images("gray", std::move(all), Boxes(static_cast<std::size_t>(images), Box{40, 30, 24, 20}));
}

class Relighting : public testing::TestWithParam<LightChange> {};

// What the camera records of a grey object under the light, relative to image 0, is the truth.
TEST_P(Relighting, TheTruthIsWhatWasAppliedInLinearLight) {
  const Film film = gray_film(60, 200);
  const cv::Size size(kWidth, kHeight);
  const auto course = LightCourse::changing(GetParam(), film.size(), size, 7);
  const Film changed = relit(film, course);
  const auto truth = true_lights(film, course, size);
  const auto mean_linear = [&](int i) {
    const Box& box = *film.truth[static_cast<std::size_t>(i)];
    const cv::Rect pixels(static_cast<int>(box.x), static_cast<int>(box.y), static_cast<int>(box.width),
                          static_cast<int>(box.height));
    const cv::Mat patch = changed.image(i)->bgr(pixels).clone();
    Light sum{0, 0, 0};
    for (const auto& pixel : cv::Mat_<cv::Vec3b>(patch)) {
      sum.r += srgb_linear(pixel[2] / 255.0) / patch.total();
      sum.g += srgb_linear(pixel[1] / 255.0) / patch.total();
      sum.b += srgb_linear(pixel[0] / 255.0) / patch.total();
    }
    return sum;
  };
  const double texture = srgb_linear(200 / 255.0);
  const Light first = mean_linear(0);
  for (int i = 0; i < film.size(); i += 7) {
    const Light here = mean_linear(i);
    const auto ratio = [&](double now, double then) {
      return srgb_encoded(now / texture) / srgb_encoded(then / texture);
    };
    ASSERT_TRUE(truth[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(truth[static_cast<std::size_t>(i)]->r, ratio(here.r, first.r), 0.01) << i;
    EXPECT_NEAR(truth[static_cast<std::size_t>(i)]->g, ratio(here.g, first.g), 0.01) << i;
    EXPECT_NEAR(truth[static_cast<std::size_t>(i)]->b, ratio(here.b, first.b), 0.01) << i;
  }
}

TEST_P(Relighting, GainsStayInTheirRangeAndAreTheSeeds) {
  const cv::Size size(kWidth, kHeight);
  const auto course = LightCourse::changing(GetParam(), 300, size, 3);
  const auto again = LightCourse::changing(GetParam(), 300, size, 3);
  const double least = GetParam() == LightChange::kDimming ? 0.25 : 0.5;
  double low = 1.0, high = 0.0;
  for (int i = 0; i < course.images(); ++i) {
    for (const double x : {1.0, 80.0, 159.0}) {
      const Light gain = course.gain(i, x, 60.0);
      EXPECT_EQ(gain.r, again.gain(i, x, 60.0).r);
      low = std::min({low, gain.r, gain.g, gain.b});
      high = std::max({high, gain.r, gain.g, gain.b});
    }
  }
  EXPECT_GE(low, least - 1e-9);
  EXPECT_LE(high, 1.0 + 1e-9);
  EXPECT_GT(high - low, 0.3);
}

INSTANTIATE_TEST_SUITE_P(Every, Relighting, testing::ValuesIn(kLightChanges), [](const auto& change) {
  std::string name;
  for (const char c : to_string(change.param)) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return name;
});

TEST(RelightingOfOnePixel, HalfTheLightIsHalfInLinearLight) {
  const cv::Mat one(1, 2, CV_8UC3, cv::Scalar(255, 128, 60));
  const cv::Mat dark = relit_picture(one, LightCourse::constant({0.5, 0.5, 0.5}, 1), 0);

  const auto pixel = dark.at<cv::Vec3b>(0, 0);
  EXPECT_EQ(pixel[0], 188);  // .5 encoded by the sRGB curve
  EXPECT_NEAR(srgb_linear(pixel[1] / 255.0) / srgb_linear(128 / 255.0), 0.5, 0.01);
}

TEST(FoldsOfTheBenchmark, EverySceneIsInExactlyOne) {
  const auto folds = Folds::shipped();
  ASSERT_TRUE(folds) << folds.error().message;
  EXPECT_EQ(folds->of("tiger1"), folds->of("coke"));
  EXPECT_EQ(folds->of("Skating1"), folds->of("skating2"));
  EXPECT_EQ(folds->of("car4"), folds->of("car1"));
  EXPECT_EQ(folds->of("walking"), folds->of("walking2"));
  for (const char* name : {"", "x", "walking", "Sylvester", "human9"}) {
    EXPECT_GE(folds->of(name), 1);
    EXPECT_LE(folds->of(name), kFolds);
  }
}

TEST(FoldsOfTheBenchmark, ASceneInTwoFoldsIsRefusedWithItsLine) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "folds.txt") << "1 plant coke\n2 plant tiger1\n";
  const auto folds = Folds::read(folder / "folds.txt");
  ASSERT_FALSE(folds);
  EXPECT_NE(folds.error().message.find("folds.txt:2:"), std::string::npos) << folds.error().message;
}

TEST(FoldsOfTheBenchmark, EveryRecordedSequenceIsListed) {
  CGSR_NEEDS_REAL_DATA("tracking");
  const std::vector<std::filesystem::path> roots{test::real_data("tracking"), test::real_data("people/human3")};
  const auto sequences = find_sequences(roots);
  ASSERT_TRUE(sequences) << sequences.error().message;
  const auto folds = Folds::shipped();
  ASSERT_TRUE(folds);
  std::set<int> used;
  for (const Sequence& sequence : *sequences) used.insert(folds->of(sequence.name));
  EXPECT_EQ(used.size(), static_cast<std::size_t>(kFolds));
}

TEST(SequenceFolders, WhatIsMissingIsNamed) {
  const test::ScratchFolder folder;
  const std::vector<std::filesystem::path> missing{folder / "none"};
  EXPECT_FALSE(find_sequences(missing));
  std::filesystem::create_directories(folder / "empty");
  const std::vector<std::filesystem::path> empty{folder / "empty"};
  const auto found = find_sequences(empty);
  ASSERT_FALSE(found);
  EXPECT_NE(found.error().message.find("holds no sequence"), std::string::npos);
}

/// A peer that counts how often it runs.
int runs = 0;
class Counted final : public BoxTracker {
 public:
  Result<LearnedObject> learn(const Image&, const Box& box) override {
    ++runs;
    box_ = box;
    return LearnedObject{};
  }
  Sighting track(const Image&) override { return {.box = box_, .light = {}, .exact_light = {}, .confidence = 1.0}; }

 private:
  Box box_;
};

TEST(CacheOfRuns, TheSameKeyIsNotRunAgain) {
  const test::ScratchFolder folder;
  const RunCache cache(folder / "runs");
  const auto make = [](const config::Color&) -> std::unique_ptr<BoxTracker> { return std::make_unique<Counted>(); };
  const NamedTracker peer{"counted", make, "option 1"};
  const NamedTracker other{"counted", make, "option 2"};
  const auto film = hashed(gray_film(5, 100)), brighter = hashed(gray_film(5, 101));
  ASSERT_TRUE(film && brighter);
  const RunStart start{0, {40.25, 30, 24, 20}};

  runs = 0;
  const auto first = run_or_recall(peer, {}, *film, start, cache);
  const auto again = run_or_recall(peer, {}, *film, start, cache);
  ASSERT_TRUE(first && again);
  EXPECT_EQ(runs, 1);
  EXPECT_EQ(first->boxes(), again->boxes());

  ASSERT_TRUE(run_or_recall(other, {}, *film, start, cache));
  ASSERT_TRUE(run_or_recall(peer, {}, *brighter, start, cache));
  ASSERT_TRUE(run_or_recall(peer, {}, *film, {0, {41, 30, 24, 20}}, cache));
  EXPECT_EQ(runs, 4);
}

/// A red square that crosses a fixed background of noise.
Film square_film(int images) {
  cv::Mat background(kHeight, kWidth, CV_8UC3);
  Random random(4);
  for (auto& pixel : cv::Mat_<cv::Vec3b>(background)) {
    for (int c = 0; c < 2; ++c) pixel[c] = static_cast<std::uint8_t>(random.below(256));
    pixel[2] = 40;
  }
  cv::resize(background(cv::Rect(0, 0, kWidth / 4, kHeight / 4)).clone(), background, background.size(), 0, 0,
             cv::INTER_CUBIC);
  std::vector<Image> all;
  Boxes truth;
  for (int i = 0; i < images; ++i) {
    cv::Mat picture = background.clone();
    const cv::Rect square(10 + i, 50, 20, 20);
    picture(square).setTo(cv::Scalar(0, 0, 255));
    all.push_back(image_of_bgr(picture));
    truth.push_back(Box{10.0 + i, 50, 20, 20});
  }
  return film_of_images("square", std::move(all), truth);
}

TEST(PaintedOver, TheObjectsPixelsAreGone) {
  const Film film = square_film(100);
  PaintShares shares;
  const auto painted = painted_over(film, 50, &shares);
  ASSERT_TRUE(painted) << painted.error().message;

  int red = 0;
  for (const auto& pixel : cv::Mat_<cv::Vec3b>(*painted)) red += pixel[2] > 150 && pixel[0] < 100 && pixel[1] < 100;
  EXPECT_EQ(red, 0);
  EXPECT_GT(shares.neighbours, 0.9);
  // The background is the recorded one: image 0 shows it where the square of image 50 is.
  const cv::Rect where(62, 52, 16, 16);
  cv::Mat difference;
  cv::absdiff((*painted)(where), film.image(0)->bgr(where), difference);
  EXPECT_LT(cv::mean(difference)[1], 12.0);
}

TEST(PaintedOver, TheFilmIsKeptAndReadAgain) {
  const test::ScratchFolder folder;
  const Film film = square_film(100);
  const AbsentRange range = absent_range(film.truth);
  EXPECT_EQ(range.count, kAbsentImages);
  const auto absent = film_without_object(film, {20, 2}, folder / "absent");
  ASSERT_TRUE(absent) << absent.error().message;
  EXPECT_FALSE(absent->truth[20]);
  EXPECT_TRUE(absent->truth[19] && absent->truth[22]);
  ASSERT_TRUE(std::filesystem::exists(folder / "absent/0021.png"));

  const auto again = film_without_object(film, {20, 2}, folder / "absent");
  ASSERT_TRUE(again);
  EXPECT_EQ(cv::norm(absent->image(21)->bgr, again->image(21)->bgr, cv::NORM_INF), 0.0);
}

TEST(TableOfChoices, AGainIsKeptOnlyWhenItHoldsInFourFolds) {
  const auto folds = Folds::shipped();
  ASSERT_TRUE(folds);
  std::map<std::string, double> before, everywhere, one_sequence;
  for (const char* name : {"coke", "subway", "dragonbaby", "dog", "deer", "biker", "crossing", "girl", "man", "bus"}) {
    before[name] = 0.5;
    everywhere[name] = 0.55;
    one_sequence[name] = 0.5;
  }
  one_sequence["coke"] = 1.0;

  const Choice good = compare(before, everywhere, *folds, 1), lucky = compare(before, one_sequence, *folds, 1);

  EXPECT_TRUE(good.is_kept());
  EXPECT_NEAR(good.gain, 0.05, 1e-12);
  EXPECT_EQ(good.won, 10);
  EXPECT_FALSE(lucky.is_kept());
  EXPECT_NEAR(lucky.gain, 0.05, 1e-12);
}

}  // namespace
}  // namespace cgsr::lab
