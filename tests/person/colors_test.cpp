#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/person/colors/blobs.h"
#include "pipeline/person/colors/color_histogram.h"
#include "pipeline/person/colors/person_colors.h"

namespace cgsr::person {
namespace {

using imaging::Rgb;

// What OpenCV says of one label: the largest area and its box.
Blob largest_by_opencv(const std::vector<std::uint16_t>& labels, int width, int height, std::uint16_t label) {
  cv::Mat mask(height, width, CV_8UC1), numbers, statistics, centres;
  for (int i = 0; i < width * height; ++i) mask.data[i] = labels[static_cast<std::size_t>(i)] == label ? 1 : 0;
  const int count = cv::connectedComponentsWithStats(mask, numbers, statistics, centres, 8);
  Blob largest;
  for (int i = 1; i < count; ++i) {
    const int* row = statistics.ptr<int>(i);
    if (row[cv::CC_STAT_AREA] <= largest.area_px) continue;
    largest = {label,
               row[cv::CC_STAT_AREA],
               {double(row[cv::CC_STAT_LEFT]), double(row[cv::CC_STAT_TOP]), double(row[cv::CC_STAT_WIDTH]),
                double(row[cv::CC_STAT_HEIGHT])}};
  }
  return largest;
}

// Whatever the image, diagonal joins included, the largest blob of each label is OpenCV's.
TEST(Blobs, AreThoseOfConnectedComponents) {
  std::mt19937 random(20261125);
  BlobFinder finder;
  for (int trial = 0; trial < 200; ++trial) {
    const int width = 1 + static_cast<int>(random() % 40), height = 1 + static_cast<int>(random() % 40);
    const unsigned kinds = 2 + random() % 4;
    std::vector<std::uint16_t> labels(static_cast<std::size_t>(width * height));
    for (auto& label : labels) label = static_cast<std::uint16_t>(random() % kinds);
    const auto blobs = finder.largest(labels, width, height, 3);
    std::map<std::uint16_t, Blob> by_label;
    for (const Blob& blob : blobs) by_label[blob.label] = blob;
    EXPECT_EQ(by_label.size(), blobs.size());
    for (std::uint16_t label = 1; label <= 4; ++label) {
      const Blob expected = largest_by_opencv(labels, width, height, label);
      if (label == 4 || expected.area_px == 0) {
        EXPECT_EQ(by_label.count(label), 0U);
        continue;
      }
      ASSERT_EQ(by_label.count(label), 1U) << trial;
      EXPECT_EQ(by_label[label].area_px, expected.area_px) << trial;
    }
  }
}

TEST(Blobs, JoinDiagonallyAndKeepTheirBox) {
  const std::vector<std::uint16_t> labels{1, 0, 0, 0,  //
                                          0, 1, 0, 2,  //
                                          0, 0, 1, 0,  //
                                          0, 1, 0, 0};
  BlobFinder finder;
  const auto blobs = finder.largest(labels, 4, 4, 9);
  ASSERT_EQ(blobs.size(), 2U);
  EXPECT_EQ(blobs[0].area_px, 4);
  EXPECT_EQ(blobs[0].box, (Box{0, 0, 3, 4}));
  EXPECT_EQ(blobs[1].box, (Box{3, 1, 1, 1}));
  EXPECT_EQ(finder.all(2).size(), 1U);
  EXPECT_TRUE(finder.largest({}, 0, 0, 9).empty());
}

std::vector<Rgb> around(const Rgb& color, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> noise(-0.02, 0.02);
  std::vector<Rgb> samples;
  for (int i = 0; i < 400; ++i)
    samples.push_back({color.r + noise(random), color.g + noise(random), color.b + noise(random)});
  return samples;
}

std::uint16_t label_of(const imaging::LabelTable& map, const Rgb& color) {
  const auto yuv = imaging::yuv_of_rgb(color);
  const auto whole = [](double value) { return static_cast<int>(value + 0.5); };
  return map[imaging::color_code(4 * whole(yuv.y), 2 * whole(yuv.u), 2 * whole(yuv.v))];
}

constexpr Rgb kRed{0.6, 0.15, 0.15}, kGreen{0.15, 0.5, 0.2}, kGrey{0.5, 0.5, 0.5};

TEST(PersonColors, MapEachColorToItsPersonAndTheBackgroundToNobody) {
  PersonColors colors;
  colors.learn(5, around(kRed, 1), around(kGrey, 2));
  colors.learn(9, around(kGreen, 3), around(kGrey, 4));
  imaging::LabelTable map;
  colors.make_map({}, map);
  EXPECT_EQ(colors.order(), (std::vector<Label>{5, 9}));
  EXPECT_EQ(label_of(map, kRed), 1);
  EXPECT_EQ(label_of(map, kGreen), 2);
  EXPECT_EQ(label_of(map, kGrey), 0);
}

// Most codes are passed over by one look; the map is still that of every code's own share.
TEST(PersonColors, MapEveryCodeByItsShareHoweverFewAreLookedAt) {
  PersonColors colors;
  colors.learn(3, around(kRed, 1), {});
  imaging::LabelTable map;
  for (const color::Light& light : {*colors.learned_light(3), color::Light{0.9, 0.9, 0.9}}) {
    colors.make_map(std::span(&light, 1), map);
    int labelled = 0;
    for (int code = 0; code < imaging::kColorCodes; ++code) {
      const double share = colors.share(3, imaging::rgb_of_code(static_cast<std::uint16_t>(code)), light);
      // In another light colours up to three bins away count, not one: along the line of a cloth's colours 7 in place of 3.
      const double min_share = PersonColorParameters{}.min_share * (light.r == 0.9 ? 7.0 / 3.0 : 1.0);
      const bool is_shirt = share >= min_share;
      ASSERT_EQ(map[static_cast<std::size_t>(code)], is_shirt ? 1 : 0) << code;
      labelled += is_shirt ? 1 : 0;
    }
    EXPECT_GT(labelled, 0);
  }
}

// Plain cloth in one light has few codes. Under a light that is a little brighter it has others, and is found by them.
TEST(PersonColors, FindPlainClothInALightThatIsALittleAnother) {
  PersonColors colors;
  std::vector<Rgb> cloth;
  const auto at = [](double shade, double gain) {
    return Rgb{0.06 * shade * gain, 0.65 * shade * gain, 0.18 * shade * gain};
  };
  const auto recorded = [](const Rgb& color) {
    const auto yuv = imaging::yuv_of_rgb(color);
    const auto whole = [](double value) { return static_cast<int>(value + 0.5); };
    return imaging::rgb_of_code(imaging::color_code(4 * whole(yuv.y), 2 * whole(yuv.u), 2 * whole(yuv.v)));
  };
  constexpr int kShades = 400;
  const auto shade = [](int i) { return 0.9 + 0.1 * i / kShades; };
  for (int i = 0; i < kShades; ++i) cloth.push_back(recorded(at(shade(i), 1.0)));
  colors.learn(1, cloth, around(kGrey, 2));
  for (const double gain : {0.8, 0.92, 0.96, 1.04, 1.08, 1.2}) {
    const color::Light learned = *colors.learned_light(1);
    const color::Light light = color::lit(learned, {gain, gain, gain});
    imaging::LabelTable map;
    colors.make_map(std::span(&light, 1), map);
    int found = 0;
    for (int i = 0; i < kShades; ++i) found += label_of(map, at(shade(i), gain)) == 1 ? 1 : 0;
    EXPECT_GE(found, 0.95 * kShades) << gain;
    EXPECT_EQ(label_of(map, kGrey), 0) << gain;
  }
}

TEST(PersonColors, GiveEqualShirtsToTheLatestPersonOfInterest) {
  PersonColors colors;
  colors.learn(1, around(kRed, 1), {});
  colors.learn(2, around(kRed, 2), {});
  imaging::LabelTable map;
  colors.make_map({}, map);
  EXPECT_EQ(label_of(map, kRed), 2);
  colors.prefer(1);
  colors.make_map({}, map);
  EXPECT_EQ(label_of(map, kRed), 1);
}

// Negative samples take a colour away: the white shirt before the white wall (6.3.1).
TEST(PersonColors, LeaveOutWhatTheBackgroundHasAsWell) {
  PersonColors colors;
  auto shirt = around(kRed, 1);
  for (const Rgb& white : around({0.9, 0.9, 0.9}, 2)) shirt.push_back(white);
  colors.learn(1, shirt, {});
  imaging::LabelTable map;
  colors.make_map({}, map);
  EXPECT_EQ(label_of(map, {0.9, 0.9, 0.9}), 1);
  colors.add(1, {}, around({0.9, 0.9, 0.9}, 3));
  colors.make_map({}, map);
  EXPECT_EQ(label_of(map, {0.9, 0.9, 0.9}), 0);
  EXPECT_EQ(label_of(map, kRed), 1);
}

TEST(PersonColors, FindAShirtUnderAnotherLight) {
  PersonColors colors;
  colors.learn(1, around(kRed, 1), around(kGrey, 2));
  const auto learned = colors.learned_light(1);
  ASSERT_TRUE(learned);
  const color::Light now{0.6 * learned->r, 0.75 * learned->g, 0.9 * learned->b};
  const Rgb seen{kRed.r * 0.6, kRed.g * 0.75, kRed.b * 0.9};
  imaging::LabelTable map;
  colors.make_map({}, map);
  EXPECT_EQ(label_of(map, seen), 0);
  colors.make_map(std::vector{now}, map);
  EXPECT_EQ(label_of(map, seen), 1);
}

// Codes that were found under a light before are used again, as long as nothing was learned since.
TEST(PersonColors, MapALightThatComesBackAsItWas) {
  PersonColors colors;
  colors.learn(1, around(kRed, 1), around(kGrey, 2));
  const std::vector bright{color::Light{0.9, 0.9, 0.9}}, dim{color::Light{0.5, 0.5, 0.5}};
  const auto map_of = [&colors](const std::vector<color::Light>& lights) {
    imaging::LabelTable map;
    colors.make_map(lights, map);
    return map;
  };
  const auto in_bright = map_of(bright), in_dim = map_of(dim);
  ASSERT_NE(in_bright, in_dim);
  EXPECT_EQ(map_of(bright), in_bright);
  EXPECT_EQ(map_of(dim), in_dim);
  EXPECT_NE(map_of({{0.7, 0.7, 0.7}}), in_dim) << "a third";
  EXPECT_EQ(map_of(bright), in_bright);
  colors.add(1, around(kGreen, 3), {});
  EXPECT_NE(map_of(bright), in_bright);
  EXPECT_NE(map_of(dim), in_dim) << "what was learned counts under both";
}

TEST(PersonColors, KeepSoManyPeopleAndForgetByNumber) {
  PersonColorParameters parameters;
  parameters.max_people = 3;
  PersonColors colors(parameters);
  for (Label person = 1; person <= 1000; ++person) colors.learn(person, around(kRed, 1), {});
  EXPECT_EQ(colors.people(), 3U);
  EXPECT_TRUE(colors.knows(1000));
  EXPECT_FALSE(colors.knows(1));
  colors.forget(1000);
  EXPECT_FALSE(colors.knows(1000));
  colors.learn(7, {}, around(kGrey, 1));
  EXPECT_FALSE(colors.knows(7)) << "no positive sample, nothing to find";
}

TEST(ColorHistogram, FadesInsteadOfGrowing) {
  ColorHistogram histogram;
  for (int i = 0; i < 200; ++i) histogram.add(around(kRed, 1));
  EXPECT_GT(histogram.share(kRed), 0.1);
  for (int i = 0; i < 200; ++i) histogram.add(around(kGreen, 1));
  EXPECT_LT(histogram.share(kRed), 0.01);
  EXPECT_EQ(ColorHistogram().share(kRed), 0.0);
}

TEST(SamplingRegions, LieAsInTheDissertation) {
  const auto regions = sampling_regions({100, 50, 40, 40});
  EXPECT_EQ(regions.shirt, (Box{100, 110, 40, 40}));
  EXPECT_EQ(regions.background[0], (Box{40, 50, 40, 40}));
  EXPECT_EQ(regions.background[1], (Box{160, 50, 40, 40}));
}

TEST(RegionColors, AreThoseOfTheImageAndNoneOutside) {
  const std::vector<std::uint8_t> pixels{100, 128, 100, 128, 200, 100, 200, 150,
                                         100, 128, 100, 128, 200, 100, 200, 150};
  const ImageView image{pixels.data(), 4, 2, 8, PixelFormat::kYuyv};
  EXPECT_EQ(region_colors(image, {0, 0, 4, 2}).size(), 2U);
  EXPECT_EQ(region_colors(image, {-5, -5, 100, 100}).size(), 2U);
  EXPECT_TRUE(region_colors(image, {10, 0, 4, 2}).empty());
  EXPECT_TRUE(region_colors(image, {}).empty());
  EXPECT_TRUE(region_colors({}, {0, 0, 4, 2}).empty());
}

}  // namespace
}  // namespace cgsr::person
