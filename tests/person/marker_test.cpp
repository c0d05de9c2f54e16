// Drawn markers: reading them near a place and in the whole image, and following them.

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/person/marker/marker_detector.h"
#include "pipeline/person/marker/marker_tracks.h"
#include "tests/person/drawn_marker.h"

namespace cgsr::person {
namespace {

constexpr int kWidth = 640, kHeight = 480;
constexpr imaging::Rgb kWall{0.6, 0.6, 0.6};
constexpr double kMinSide_px = 20.0, kRegion = 2.5;

Drawing wall() {
  return {kWidth, kHeight, kWall};
}

Drawing with_marker(int id, const Box& box) {
  Drawing drawing = wall();
  drawing.mark(id, box);
  return drawing;
}

Box square(double x, double y, double side) {
  return {x, y, side, side};
}

void expect_at(const Box& found, const Box& drawn, double share = 0.04) {
  const double tolerance = 1.0 + share * drawn.width;
  EXPECT_NEAR(found.x, drawn.x, tolerance);
  EXPECT_NEAR(found.y, drawn.y, tolerance);
  EXPECT_NEAR(found.width, drawn.width, tolerance);
  EXPECT_NEAR(found.height, drawn.height, tolerance);
}

/// A round of the search through one image.
std::vector<SeenMarker> search_all(MarkerDetector& detector, const ImageView& image) {
  std::vector<SeenMarker> all, found;
  for (std::size_t i = 0; i < detector.steps(image.width_px, image.height_px); ++i) {
    detector.search(image, found);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

class OneUnit final : public WorkBudget {
 public:
  bool grant() override { return left_-- > 0; }

 private:
  int left_ = 1;
};

TEST(MarkerDetector, ReadsAMarkerOfAnySizeNearWhereItIsExpected) {
  MarkerDetector detector(kMinSide_px, kRegion);
  for (const double side : {20.0, 30.0, 48.0, 90.0, 150.0, 280.0}) {
    const Box box = square(300 - side / 2, 230 - side / 2, side);
    const Drawing drawing = with_marker(7, box);
    for (const double off : {-0.2, 0.0, 0.2}) {
      const auto seen = detector.find_near(drawing.view(), square(box.x + off * side, box.y - off * side, side), 7);
      ASSERT_TRUE(seen) << side << " px, " << off;
      EXPECT_EQ(seen->id, 7);
      EXPECT_EQ(seen->search, MarkerSearch::kPrediction);
      EXPECT_GT(seen->confidence, 0.9);
      expect_at(seen->box, box);
    }
  }
}

// Wherever a marker is and however large, one round meets it: no gap between tiles or between sizes.
TEST(MarkerDetector, MeetsEveryMarkerInOneRoundThroughTheWholeImage) {
  std::mt19937 random(20);
  MarkerDetector detector(kMinSide_px, kRegion);
  for (int trial = 0; trial < 60; ++trial) {
    const double side = std::floor(20.0 * std::pow(16.0, std::uniform_real_distribution<>(0.0, 1.0)(random)));
    const double margin = side / 6;
    const auto within = [&](double length) {
      return std::floor(std::uniform_real_distribution<>(margin, length - side - margin)(random));
    };
    const Box box = square(within(kWidth), within(kHeight), side);
    const Drawing drawing = with_marker(trial % 50, box);
    const auto found = search_all(detector, drawing.view());
    ASSERT_FALSE(found.empty()) << side << " px at " << box.x << ", " << box.y;
    for (const SeenMarker& seen : found) {
      EXPECT_EQ(seen.id, trial % 50);
      EXPECT_EQ(seen.search, MarkerSearch::kWholeImage);
      expect_at(seen.box, box, 0.12);  // two pixels where its side is seen as 14 or more
    }
  }
}

TEST(MarkerDetector, DoesNotReadAMarkerOfAnotherId) {
  MarkerDetector detector(kMinSide_px, kRegion);
  const Box box = square(300, 200, 60);
  const Drawing drawing = with_marker(7, box);
  EXPECT_FALSE(detector.find_near(drawing.view(), box, 8));
  EXPECT_TRUE(detector.find_near(drawing.view(), box, 7));
}

TEST(MarkerDetector, DoesNotReadACoveredMarker) {
  MarkerDetector detector(kMinSide_px, kRegion);
  const Box box = square(300, 200, 60);
  Drawing drawing = with_marker(7, box);
  drawing.fill({box.x - 10, box.y + 35, 80, 40}, {0.4, 0.3, 0.2});  // an arm
  EXPECT_FALSE(detector.find_near(drawing.view(), box, 7));
  EXPECT_TRUE(search_all(detector, drawing.view()).empty());
}

TEST(MarkerDetector, ReadsAMarkerAtTheBorderAndNotOneThatIsCutOff) {
  MarkerDetector detector(kMinSide_px, kRegion);
  for (const double side : {30.0, 60.0}) {
    const double margin = std::floor(side / 6);
    for (const Box& box :
         {square(margin, margin, side), square(kWidth - side - margin, kHeight - side - margin, side)}) {
      EXPECT_TRUE(detector.find_near(with_marker(3, box).view(), box, 3)) << box.x;
    }
    const Box cut = square(-side / 4, 200, side);
    EXPECT_FALSE(detector.find_near(with_marker(3, cut).view(), cut, 3));
    const Box outside = square(kWidth + 100, 200, side);
    EXPECT_FALSE(detector.find_near(with_marker(3, outside).view(), outside, 3));
  }
}

// Blur of a cell's width ends the reading; on the way there no marker turns into another one, and confidence falls.
TEST(MarkerDetector, BlurEndsTheReadingAndNeverMakesAnotherMarker) {
  MarkerDetector detector(kMinSide_px, kRegion);
  const Box box = square(300, 200, 60);  // 10 px for each cell
  int sharp = 0, smeared = 0;
  for (int id = 0; id < 50; id += 5) {
    for (const int length : {1, 4, 24, 40}) {
      Drawing drawing = with_marker(id, box);
      drawing.blur(length);
      const auto seen = detector.find_near(drawing.view(), box, id);
      (length <= 4 ? sharp : smeared) += seen ? 1 : 0;
      for (const SeenMarker& any : search_all(detector, drawing.view())) EXPECT_EQ(any.id, id) << length << " px";
    }
  }
  EXPECT_EQ(sharp, 20);
  EXPECT_LE(smeared, 2) << "of 20";
}

TEST(MarkerDetector, FindsNothingInNoiseAndInAnEmptyImage) {
  MarkerDetector detector(kMinSide_px, kRegion);
  EXPECT_EQ(detector.steps(0, 0), 0U);
  std::vector<SeenMarker> found;
  detector.search({}, found);
  EXPECT_TRUE(found.empty());
  EXPECT_FALSE(detector.find_near({}, square(10, 10, 40), 7));
  EXPECT_FALSE(detector.find_near(wall().view(), {}, 7));
  cv::RNG random(4);
  for (int image = 0; image < 20; ++image) {
    Drawing drawing = wall();
    cv::Mat noise(24, 32, CV_8U), texture;
    random.fill(noise, cv::RNG::UNIFORM, 20, 230);
    cv::resize(noise, texture, {kWidth, kHeight}, 0, 0, image % 2 == 0 ? cv::INTER_NEAREST : cv::INTER_CUBIC);
    drawing.paste(texture, 0, 0);
    EXPECT_LE(search_all(detector, drawing.view()).size(), 1U);
  }
}

class MarkerTracking : public testing::Test {
 protected:
  MarkerTracking() { parameters_.id = 7; }

  /// Looks at an image until a round through all of it is over.
  static void look_long(MarkerTracks& tracks, const ImageView& image) {
    UnlimitedBudget budget;
    for (int i = 0; i < 40; ++i) tracks.look(image, budget);
  }

  MarkerParameters parameters_;
};

TEST_F(MarkerTracking, CountsAMarkerThatWasReadTwiceAndThenLooksAroundItsPlaceAlone) {
  MarkerTracks tracks(parameters_);
  const Drawing drawing = with_marker(7, square(300, 200, 40));
  int images = 0;
  while (!tracks.sighting() && images < 40) {
    OneUnit unit;
    tracks.look(drawing.view(), unit);
    ++images;
  }
  EXPECT_GT(images, 1);
  ASSERT_TRUE(tracks.sighting()) << "one unit in each image is enough";
  EXPECT_EQ(tracks.seen()->search, MarkerSearch::kPrediction);
  EXPECT_EQ(tracks.sighting()->person, parameters_.number);
  EXPECT_NEAR(tracks.sighting()->face.width, 40 / parameters_.side_per_face, 2.0);
}

TEST_F(MarkerTracking, KeepsUpWithAMarkerThatMoves) {
  MarkerTracks tracks(parameters_);
  look_long(tracks, with_marker(7, square(60, 200, 40)).view());
  ASSERT_TRUE(tracks.sighting());
  double x = 60.0;
  for (int image = 0; image < 20; ++image) {
    x += std::min(image + 1, 20);  // up to half a side from image to image
    OneUnit unit;
    tracks.look(with_marker(7, square(x, 200, 40)).view(), unit);
    ASSERT_TRUE(tracks.sighting()) << image;
    EXPECT_NEAR(tracks.sighting()->box.x, x, 3.0);
  }
}

TEST_F(MarkerTracking, FindsAMarkerAgainAfterItWasCovered) {
  MarkerTracks tracks(parameters_);
  const Drawing shown = with_marker(7, square(300, 200, 40));
  const Drawing covered = wall();
  look_long(tracks, shown.view());
  for (int image = 0; image < 3; ++image) {
    OneUnit unit;
    tracks.look(covered.view(), unit);
    EXPECT_FALSE(tracks.sighting());
  }
  OneUnit unit;
  tracks.look(shown.view(), unit);
  EXPECT_TRUE(tracks.sighting()) << "at once, where it was";
  look_long(tracks, covered.view());
  EXPECT_FALSE(tracks.sighting());
  look_long(tracks, with_marker(7, square(80, 90, 30)).view());
  EXPECT_TRUE(tracks.sighting()) << "elsewhere, after a round";
}

TEST_F(MarkerTracking, CallsWhoeverWearsAnotherMarkerAStrangerUnlessThePersonsIsThere) {
  MarkerTracks tracks(parameters_);
  Drawing drawing = with_marker(9, square(300, 200, 40));
  look_long(tracks, drawing.view());
  ASSERT_TRUE(tracks.sighting());
  EXPECT_EQ(tracks.sighting()->person, std::nullopt);
  drawing.mark(7, square(480, 210, 40));
  look_long(tracks, drawing.view());
  ASSERT_TRUE(tracks.sighting());
  EXPECT_EQ(tracks.sighting()->person, parameters_.number);
  EXPECT_EQ(tracks.seen()->id, 7);
}

TEST_F(MarkerTracking, DoesNothingWithoutABudget) {
  class Nothing final : public WorkBudget {
   public:
    bool grant() override { return false; }
  } nothing;
  MarkerTracks tracks(parameters_);
  const Drawing drawing = with_marker(7, square(300, 200, 40));
  for (int image = 0; image < 40; ++image) tracks.look(drawing.view(), nothing);
  EXPECT_FALSE(tracks.sighting());
}

}  // namespace
}  // namespace cgsr::person
