#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "tools/lab/box_tracker.h"
#include "tools/lab/film.h"

namespace cgsr::lab {

/// How a light changes over a video. Gains are factors of linear light, per channel.
enum class LightChange : std::uint8_t {
  kSinusoids,  ///< a slow one per channel, .5 to 1, each with its own period and phase.
  kSteps,      ///< every 25 to 50 images another gain per channel, .5 to 1.
  kWarmCold,   ///< from warm (1, .75, .5) to cold (.5, .75, 1) and back.
  kDimming,    ///< all channels alike from 1 to a quarter by the middle of the video, and back to 1 at its end.
  kSpot,       ///< a coloured spot of light that moves over a scene lit by half: .5 to 1 where it is.
};
inline constexpr std::array kLightChanges{LightChange::kSinusoids, LightChange::kSteps, LightChange::kWarmCold,
                                          LightChange::kDimming, LightChange::kSpot};
std::string_view to_string(LightChange change);

/// A light over a video: what multiplies the linear light of each pixel of each image. The same seed gives the same light.
class LightCourse {
 public:
  /// \param seed  of what is drawn: periods, phases, levels, the spot's colour and way.
  static LightCourse changing(LightChange change, int images, const cv::Size& size, std::uint64_t seed);

  /// One gain for all pixels of all images.
  static LightCourse constant(const Light& gain, int images);

  [[nodiscard]] int images() const { return static_cast<int>(base_.size()); }
  /// \param x_px, y_px  a point of image `image`; the centre of the top left pixel is (.5, .5).
  [[nodiscard]] Light gain(int image, double x_px, double y_px) const;
  /// \return whether all pixels of an image have one gain.
  [[nodiscard]] bool is_uniform() const { return spots_.empty(); }
  /// \return over the pixels whose centres lie in the box; of the whole image where none does.
  [[nodiscard]] Light mean_gain(int image, const Box& box, const cv::Size& size) const;

 private:
  struct Spot {
    double x_px = 0.0, y_px = 0.0, sigma_px = 1.0;
    Light added;  ///< at its centre
  };
  std::vector<Light> base_;  ///< one per image
  std::vector<Spot> spots_;  ///< none, or one per image
};

/// \return the picture under such a light: decoded from sRGB, multiplied, encoded again and rounded to 8 bits.
cv::Mat relit_picture(const cv::Mat& bgr, const LightCourse& light, int image);

/// \return the film under a light; images are made when they are asked for.
Film relit(const Film& film, const LightCourse& light);

/// The true light of the object: mean gain over the true box, encoded by the sRGB curve, divided by that of image 0, whose object is visible.
/// \return one entry per image; nothing where the object is not visible.
std::vector<std::optional<Light>> true_lights(const Film& film, const LightCourse& light, const cv::Size& size);

/// \return the mean over the images of the mean gain over the true box: what a constant light is to have that is no brighter or darker.
Light mean_gain_of_object(const Film& film, const LightCourse& light, const cv::Size& size);

/// The sRGB curve (IEC 61966-2-1). \param linear, encoded  in [0, 1].
double srgb_encoded(double linear);
double srgb_linear(double encoded);

}  // namespace cgsr::lab
