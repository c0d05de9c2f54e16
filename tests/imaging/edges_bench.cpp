// What edge pixels and segments of 320x240 images cost, as marks that tools/count reads:
//   tools/count -- build/bench/edges_bench            drawn images
//   tools/count -- build/bench/edges_bench IMAGE…     of files, taken to 320 pixels wide
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "pipeline/imaging/segments.h"
#include "platform/count_marks.h"
#include "tests/imaging/rendered_edges.h"

int main(int argc, char** argv) {
  using namespace cgsr;
  constexpr int kWidth = 320;
  constexpr int kHeight = 240;
  std::mt19937 random(1);
  imaging::EdgeDetector detector({}, kWidth, kHeight);
  imaging::SegmentFinder finder({}, kWidth, kHeight);
  for (int image = 0; image < (argc > 1 ? argc - 1 : 4); ++image) {
    std::vector<std::uint8_t> grey;
    if (argc > 1) {
      cv::Mat half;
      const cv::Mat whole = cv::imread(argv[image + 1], cv::IMREAD_GRAYSCALE);
      if (whole.empty()) {
        std::fprintf(stderr, "%s: no image\n", argv[image + 1]);
        return 1;
      }
      cv::resize(whole, half, {kWidth, kHeight}, 0.0, 0.0, cv::INTER_AREA);
      grey.assign(half.begin<std::uint8_t>(), half.end<std::uint8_t>());
    } else {
      grey = imaging::drawn::cluttered(random, kWidth, kHeight, 15 + 15 * image).bytes(random, 1.0);
    }
    count_stage_begin();
    detector.find(grey.data(), kWidth, kHeight, kWidth);
    count_stage_end("edges");
    count_stage_begin();
    finder.find(grey.data(), kWidth, kHeight, kWidth);
    count_stage_end("edges_and_segments");
    count_image_end();
    std::printf("%zu edge pixels, %zu segments\n", detector.edges().size(), finder.segments().size());
  }
  return 0;
}
