#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "platform/description/json.h"
#include "platform/image_view.h"
#include "src/sinks/recorder.h"
#include "src/sinks/ros_image.h"

namespace cgsr::test {

/// An output as a stage has it.
struct TestOutput {
  int image = 0;
  double x_m = 0.0;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.integer("image", self.image, "", "sequence number");
    visit.number("x_m", self.x_m, {3}, "m", "a place");
  }
};

enum TestTopic : std::size_t { kTrack, kImage, kJpeg };

inline std::vector<sinks::McapChannel> test_channels() {
  return {sinks::json_channel("/track", "cgsr/TestOutput", json_schema<TestOutput>("cgsr/TestOutput", "A test")),
          sinks::image_channel("/camera/image"), sinks::compressed_image_channel("/camera/jpeg")};
}

/// A YUYV image with gaps between its rows.
struct TestImage {
  static constexpr int kWidth = 32;
  static constexpr int kHeight = 24;
  static constexpr int kStride = 80;
  std::vector<std::uint8_t> bytes = std::vector<std::uint8_t>(kStride * kHeight);

  explicit TestImage(int seed) {
    for (std::size_t i = 0; i < bytes.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>(i * 7 + i / 80 + static_cast<std::size_t>(seed));
  }
  [[nodiscard]] ImageView view() const { return {bytes.data(), kWidth, kHeight, kStride, PixelFormat::kYuyv}; }
  [[nodiscard]] int sum() const {
    int total = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int i = 0; i < 2 * kWidth; ++i) total += view().row(y)[i];
    }
    return total;
  }
};

inline MonoTime test_stamp(int image) {
  return MonoTime{Duration{5'000'000'000 + image * std::int64_t{33'333'333}}};
}

inline std::filesystem::path test_file(const char* ending) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::path(testing::TempDir()) /
         fmt::format("{}_{}{}", test->test_suite_name(), test->name(), ending);
}

/// A message of every topic for each image.
inline void post_images(sinks::Recorder& recorder, int images) {
  std::string json;
  for (int i = 0; i < images; ++i) {
    json.clear();
    append_json(json, TestOutput{i, 0.5 * i});
    ASSERT_TRUE(recorder.post(kTrack, test_stamp(i), json));
    ASSERT_TRUE(recorder.post(kImage, test_stamp(i), TestImage(i).view()));
    if (i % 4 == 0) {
      ASSERT_TRUE(recorder.post(kJpeg, test_stamp(i), TestImage(i).view()));
    }
    const auto stepped = recorder.step();
    ASSERT_TRUE(stepped) << stepped.error().message;
  }
}

}  // namespace cgsr::test
