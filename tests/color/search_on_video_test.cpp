#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "pipeline/color/search/exhaustive_search.h"
#include "pipeline/color/search/window_search.h"
#include "tests/color/scene.h"
#include "tests/support/real_data.h"

namespace cgsr::color {
namespace {

/// A recorded sequence: images in the order of their names, and the box in the first one.
struct Recording {
  std::vector<std::string> images;
  Box first_box;
};

Recording recording(const std::filesystem::path& folder) {
  Recording found;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "img"))
    found.images.push_back(entry.path().string());
  std::sort(found.images.begin(), found.images.end());
  std::ifstream truth(folder / "groundtruth.txt");
  char comma = 0;
  truth >> found.first_box.x >> comma >> found.first_box.y >> comma >> found.first_box.width >> comma >>
      found.first_box.height;
  return found;
}

test::Painting picture(const std::string& path) {
  const cv::Mat bgr = cv::imread(path);
  test::Painting painting(bgr.cols & ~1, bgr.rows);
  painting.paint([&](int x, int y) {
    const auto& c = bgr.at<cv::Vec3b>(y, x);
    return imaging::Rgb{c[2] / 255.0, c[1] / 255.0, c[0] / 255.0};
  });
  return painting;
}

class SearchOnVideoContract : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const std::string name = std::string("tracking/") + GetParam();
    CGSR_NEEDS_REAL_DATA(name);
    folder_ = test::real_data(name);
  }
  std::filesystem::path folder_;
};

// On real images too, with the object there and in both modes, the fast search answers what the exhaustive one answers, and looks at few windows for it.
TEST_P(SearchOnVideoContract, IsTheExhaustiveSearch) {
  const Recording video = recording(folder_);
  ASSERT_GT(video.images.size(), 60U);
  auto first = picture(video.images[0]);
  const Sample sample{first.photograph(), video.first_box};
  const auto learned = learn({&sample, 1}, {});
  ASSERT_TRUE(learned) << learned.error().message;

  for (const auto weights : {BinWeights::kPlain, BinWeights::kSurroundings}) {
    SearchParameters parameters;
    parameters.weights = weights;
    const int width = sample.image.width_px, height = sample.image.height_px;
    auto fast = WindowSearch::create(learned->model, parameters, width, height).value();
    const ExhaustiveSearch slow(learned->model, parameters);
    imaging::ReducedImage image(width, height);
    for (const std::size_t index : {std::size_t{1}, video.images.size() / 2, video.images.size() - 1}) {
      auto now = picture(video.images[index]);
      const int factor = imaging::reduction_for(width, height, std::min(video.first_box.width, video.first_box.height));
      ASSERT_TRUE(imaging::reduce(now.photograph(), factor, fast.labels(), image));
      SearchRequest request;
      request.width_px = video.first_box.width;
      request.height_px = video.first_box.height;
      request.candidates = 3;

      const auto found = fast.search(image, request);
      const auto expected = slow.search(image, request);

      ASSERT_TRUE(found && expected);
      ASSERT_TRUE(found->exact);
      ASSERT_EQ(found->count, expected->count) << index;
      for (std::size_t i = 0; i < static_cast<std::size_t>(found->count); ++i) {
        const Match &a = found->matches[i], &b = expected->matches[i];
        ASSERT_TRUE(a.box == b.box && a.divergence == b.divergence && a.light == b.light && a.size == b.size)
            << index << " match " << i;
      }
      EXPECT_LT(found->examined, found->windows / 4) << index;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Sequences, SearchOnVideoContract,
                         ::testing::Values("coke", "dragonbaby", "deer", "crossing", "girl"),
                         [](const auto& sequence) { return std::string(sequence.param); });

}  // namespace
}  // namespace cgsr::color
