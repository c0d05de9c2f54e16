#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/color/learn/light.h"
#include "pipeline/shade/shadow_volumes.h"
#include "platform/box.h"
#include "platform/image_view.h"

namespace cgsr::app {

/// Somebody who is in view, or his face.
struct OverlayPerson {
  Box box;
  std::string text;         ///< who it is: a number, never a name.
  bool identified = false;  ///< by face or shirt; else it is a face alone.
};

/// What is written over an image for people.
struct OverlayFacts {
  std::uint64_t image_number = 0;
  std::optional<Box> box;                 ///< found object.
  std::optional<Box> truth;               ///< where it really is, when known.
  std::optional<color::Light> light;      ///< that the tracker follows; finer than the grid.
  std::optional<color::Light> plurality;  ///< of the grid's lights over the last second.
  double divergence = 0.0;
  const shade::ShadeMasks* shade =
      nullptr;  ///< what may lie in shadow: tinted, and outlined where the surface itself does.
  std::vector<OverlayPerson> people;
  std::vector<std::string> lines;  ///< free text below the image, one line each; at most five are drawn.
};

/// Draws the picture that a person looks at: the image, on it the object's box, below it the stripe of estimated lights (Fig. 3.3:
/// above the light that the tracker follows, below the plurality of the grid's) and lines of text. Not for the frame path.
class Overlay {
 public:
  /// \param image_width_px, image_height_px  of every image to come; small ones are drawn larger.
  Overlay(int image_width_px, int image_height_px);

  [[nodiscard]] cv::Size picture_size() const;

  /// \return the picture, B G R; valid until the next call.
  const cv::Mat& draw(const ImageView& image, const OverlayFacts& facts);

 private:
  void draw_box(const Box& box, const cv::Scalar& color, int thickness);
  void draw_person(const OverlayPerson& person);
  void draw_shade(const shade::ShadeMasks& shade, cv::Mat& top);
  void draw_panel(const OverlayFacts& facts);

  int width_px_;
  int height_px_;
  double zoom_;
  struct Column {
    std::optional<color::Light> light;
    std::optional<color::Light> plurality;
  };

  std::deque<Column> stripe_;
  cv::Mat picture_;
};

/// \return the image as B G R, through the same BT.601 formula that the pipeline uses.
cv::Mat to_bgr(const ImageView& image);

}  // namespace cgsr::app
