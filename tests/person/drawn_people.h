#pragma once

// Drawn people: a rectangle for a shirt, a box for a face that the test says is recognised.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/person/tracking/person_tracker.h"

namespace cgsr::person {

inline constexpr int kWidth = 320, kHeight = 240;
using imaging::Rgb;
inline constexpr Rgb kWall{0.6, 0.6, 0.6}, kRed{0.7, 0.15, 0.15}, kBlue{0.15, 0.2, 0.7};

struct Picture {
  std::vector<std::uint8_t> yuyv = std::vector<std::uint8_t>(std::size_t{2} * kWidth * kHeight);

  explicit Picture(const Rgb& wall = kWall) { fill({0, 0, kWidth, kHeight}, wall); }
  void fill(const Box& box, const Rgb& color) {
    const auto yuv = imaging::yuv_of_rgb(color);
    for (int y = static_cast<int>(box.y); y < static_cast<int>(box.y + box.height); ++y) {
      for (int x = static_cast<int>(box.x); x < static_cast<int>(box.x + box.width); ++x) {
        std::uint8_t* pixel = yuyv.data() + std::ptrdiff_t{2} * (y * kWidth + x);
        pixel[0] = static_cast<std::uint8_t>(yuv.y + 0.5);
        pixel[1] = static_cast<std::uint8_t>((x % 2 == 0 ? yuv.u : yuv.v) + 0.5);
      }
    }
  }
  [[nodiscard]] ImageView view() const { return {yuyv.data(), kWidth, kHeight, kWidth * 2, PixelFormat::kYuyv}; }
};

inline constexpr Box kFaceBox{140, 30, 40, 40};
inline constexpr Box kShirtBox{120, 80, 80, 100};

inline Picture standing(const Rgb& shirt) {
  Picture picture;
  picture.fill(kShirtBox, shirt);
  return picture;
}

inline FaceSighting face_of(std::optional<Label> person, double confidence = 0.95) {
  FaceMatch match;
  match.label = person;
  match.confidence = confidence;
  return {kFaceBox, match};
}

/// What the last look for a face said holds until the next one.
inline void pass_to_next_look(PersonTracker& tracker, const Picture& picture) {
  while (!tracker.face_is_due()) tracker.update({picture.view()});
}

inline void learn(PersonTracker& tracker, Label person, const Rgb& shirt) {
  const Picture picture = standing(shirt);
  // Ten faces; once somebody's shirt is known they are looked for in every other image only.
  for (int image = 0; image < 20 && !tracker.shirts().knows(person); ++image)
    tracker.update({picture.view(), face_of(person)});
  pass_to_next_look(tracker, picture);
}

}  // namespace cgsr::person
