#include "pipeline/color/ball/ball_model.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pipeline/color/learn/learn.h"
#include "pipeline/imaging/color_code.h"

namespace cgsr::color {
namespace {

constexpr double kCore = 0.8;          // of the radius: at the rim the background shines in
constexpr double kLeastShare = 0.012;  // of the circle, for a colour to be one of the ball's
constexpr double kDarkestLight = 0.01;
constexpr int kLightSteps = 5;    // per channel, about one of the grid
constexpr int kFactorSteps = 9;   // from the least factor to
constexpr double kSoft = 0.85;    // what is hardly dark
constexpr double kBorder = 0.03;  // by which the factors of two depths overlap

using Textures = std::vector<imaging::Rgb>;
using Codes = std::vector<int>;

std::uint16_t code_at(const SamplePatch& patch, int x, int y) {
  const std::uint8_t* pair = patch.yuyv.data() + (static_cast<std::ptrdiff_t>(y) * patch.width_px + x / 2 * 2) * 2;
  return imaging::color_code(4 * pair[x % 2 * 2], 2 * pair[1], 2 * pair[3]);
}

struct Chromaticity {
  double r = 0.0;
  double g = 0.0;

  [[nodiscard]] double square_distance(const Chromaticity& other) const {
    return (r - other.r) * (r - other.r) + (g - other.g) * (g - other.g);
  }
};

Chromaticity chromaticity_of(int code) {
  const imaging::Rgb color = imaging::rgb_of_code(static_cast<std::uint16_t>(code));
  const double r = std::max(0.0, color.r), g = std::max(0.0, color.g), b = std::max(0.0, color.b);
  const double sum = std::max(1e-6, r + g + b);
  return {r / sum, g / sum};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Without what is nearer to grey than to the ball's own colour: glints, and what hides some of it in the sample. In the dark such a pixel looks like
/// anything. All of them where that is most of the ball: it is grey itself.
Codes of_its_color(const Codes& codes) {
  constexpr Chromaticity kGrey{1.0 / 3.0, 1.0 / 3.0};
  if (codes.empty()) return codes;
  std::vector<double> r, g;
  for (const int code : codes) {
    const Chromaticity at = chromaticity_of(code);
    r.push_back(at.r);
    g.push_back(at.g);
  }
  const Chromaticity own{median(std::move(r)), median(std::move(g))};
  Codes kept;
  for (const int code : codes) {
    const Chromaticity at = chromaticity_of(code);
    if (at.square_distance(own) <= at.square_distance(kGrey)) kept.push_back(code);
  }
  return 2 * kept.size() > codes.size() ? kept : codes;
}

/// The ball's pixels in a sample, as colour codes.
Codes codes_of(const ColorModel& model, const SamplePatch& patch) {
  const Box& box = model.object_box;
  const double radius_x = 0.5 * box.width * patch.scale_x;
  const double radius_y = 0.5 * box.height * patch.scale_y;
  const double middle_x = patch.window.x + box.x * patch.scale_x + radius_x;
  const double middle_y = patch.window.y + box.y * patch.scale_y + radius_y;
  Codes codes;
  for (int y = 0; y < patch.height_px; ++y) {
    for (int x = 0; x < patch.width_px; ++x) {
      const double dx = (x + 0.5 - middle_x) / radius_x;
      const double dy = (y + 0.5 - middle_y) / radius_y;
      if (dx * dx + dy * dy < kCore * kCore) codes.push_back(code_at(patch, x, y));
    }
  }
  return codes;
}

Textures textures_of(const Codes& codes, const Light& light) {
  Textures textures;
  textures.reserve(codes.size());
  for (const int code : codes) {
    textures.push_back(without_light(imaging::rgb_of_code(static_cast<std::uint16_t>(code)), light));
  }
  return textures;
}

/// The colours that make up more than a few pixels, each once.
Textures main_textures(Codes codes, const Light& light) {
  std::sort(codes.begin(), codes.end());
  const auto least = static_cast<std::ptrdiff_t>(kLeastShare * static_cast<double>(codes.size())) + 1;
  Codes kept;
  for (auto at = codes.begin(); at != codes.end();) {
    const auto end = std::upper_bound(at, codes.end(), *at);
    if (end - at >= least) kept.push_back(*at);
    at = end;
  }
  return textures_of(kept, light);
}

void set_histograms(const std::vector<Textures>& samples, ColorModel& model) {
  model.object.clear();
  model.surroundings.clear();
  for (const Light& light : model.lights) {
    std::vector<double> mean(static_cast<std::size_t>(model.bins.count()), 0.0);
    for (const Textures& textures : samples) {
      const auto one = histogram_under(textures, light, model.bins);
      for (std::size_t bin = 0; bin < mean.size(); ++bin) mean[bin] += one[bin] / static_cast<double>(samples.size());
    }
    append_counts(mean, model.object);
  }
}

/// Half the step of the grid that the lights came from.
double half_step(const std::vector<Light>& lights) {
  std::vector<double> reds;
  reds.reserve(lights.size());
  for (const Light& light : lights) reds.push_back(light.r);
  std::sort(reds.begin(), reds.end());
  double step = 0.0;
  for (std::size_t i = 1; i < reds.size(); ++i) step = std::max(step, reds[i] - reds[i - 1]);
  return 0.5 * step + 1e-6;
}

struct Levels {
  int y, u, v;
};

Levels levels_of(const imaging::Rgb& color) {
  const auto yuv = imaging::yuv_of_rgb(
      {std::clamp(color.r, 0.0, 1.0), std::clamp(color.g, 0.0, 1.0), std::clamp(color.b, 0.0, 1.0)});
  const auto chroma = [](double value) { return static_cast<int>(value * imaging::kChromaLevels / 256.0); };
  return {static_cast<int>(yuv.y / 8.0), chroma(yuv.u), chroma(yuv.v)};
}

std::size_t index_of(const Levels& at) {
  return static_cast<std::size_t>((at.y * imaging::kChromaLevels + at.u) * imaging::kChromaLevels + at.v);
}

bool is_grey(int u, int v) {
  constexpr int kNone = imaging::kChromaLevels / 2;
  return u == kNone && v == kNone;
}

/// Marks a colour and its neighbours in each direction, but not grey as a neighbour: in the dark most of a room would be one.
void mark(const imaging::Rgb& color, std::uint8_t kind, std::vector<std::uint8_t>& of_code) {
  const Levels middle = levels_of(color);
  if ((of_code[index_of(middle)] & kind << 4) != 0) return;  // done before
  of_code[index_of(middle)] = static_cast<std::uint8_t>(of_code[index_of(middle)] | kind << 4);
  for (int y = std::max(0, middle.y - 1); y <= std::min(imaging::kYLevels - 1, middle.y + 1); ++y) {
    for (int u = std::max(0, middle.u - 1); u <= std::min(imaging::kChromaLevels - 1, middle.u + 1); ++u) {
      for (int v = std::max(0, middle.v - 1); v <= std::min(imaging::kChromaLevels - 1, middle.v + 1); ++v) {
        if (is_grey(u, v) && !is_grey(middle.u, middle.v)) continue;
        of_code[index_of({y, u, v})] = static_cast<std::uint8_t>(of_code[index_of({y, u, v})] | kind);
      }
    }
  }
}

/// A depth of shade: its factor, and what else its colours may be darkened by.
struct Depth {
  double factor = 0.0, least = 0.0, most = 0.0;
  std::uint8_t kind = 0;
};

/// From deep to soft, each up to midway to its neighbours.
std::vector<Depth> depths_of(std::vector<double> factors) {
  std::sort(factors.begin(), factors.end());
  std::vector<Depth> depths;
  const int count = static_cast<int>(factors.size());
  for (int i = 0; i < count; ++i) {
    const double factor = factors[static_cast<std::size_t>(i)];
    const double least = i == 0 ? 0.0 : 0.5 * (factors[static_cast<std::size_t>(i - 1)] + factor);
    const double most = i == count - 1 ? 1.0 : 0.5 * (factor + factors[static_cast<std::size_t>(i + 1)]);
    const int depth = count <= BallModel::kDepths ? i : i * BallModel::kDepths / count;
    depths.push_back({factor, least, most, static_cast<std::uint8_t>(BallModel::kDeepest << depth)});
  }
  return depths;
}

/// \param reach  how far other lights may be from this one in each channel.
std::vector<std::uint8_t> kinds_of_codes(const Textures& textures, const Light& light, double reach,
                                         const std::vector<Depth>& depths) {
  const double min_factor = depths.front().factor;
  std::vector<std::uint8_t> of_code(imaging::kColorCodes, 0);
  const auto near = [reach](double channel, int step) {
    return std::clamp(channel + reach * (2.0 * step / (kLightSteps - 1) - 1.0), kDarkestLight, 1.0);
  };
  for (const imaging::Rgb& texture : textures) {
    for (int r = 0; r < kLightSteps; ++r) {
      for (int g = 0; g < kLightSteps; ++g) {
        for (int b = 0; b < kLightSteps; ++b) {
          const imaging::Rgb color = lit(texture, {near(light.r, r), near(light.g, g), near(light.b, b)});
          mark(color, BallModel::kBright, of_code);
          for (int i = 0; i < kFactorSteps; ++i) {
            const double factor = min_factor + (kSoft - min_factor) * i / (kFactorSteps - 1);
            for (const Depth& depth : depths) {
              if (factor < depth.least - kBorder || factor > depth.most + kBorder) continue;
              mark({factor * color.r, factor * color.g, factor * color.b}, depth.kind, of_code);
            }
          }
        }
      }
    }
  }
  for (auto& kind : of_code) kind = static_cast<std::uint8_t>(kind & BallModel::kAny);
  return of_code;
}

}  // namespace

Result<BallModel> make_ball_model(const ColorModel& model, std::span<const double> factors) {
  if (const auto defect = defect_of(model); !defect.empty()) return fail("the colour model: " + defect);
  if (model.samples.empty()) return fail("the colour model keeps no picture of the ball: learn it again");
  if (factors.empty()) return fail("no darkness factor is given");
  for (const double factor : factors) {
    if (!(factor > 0.0 && factor <= 1.0)) return fail(fmt::format("a darkness factor of {}, not in 0..1", factor));
  }
  if (model.lights.size() * factors.size() > kMaxLights) {
    return fail(fmt::format("{} lights times {} darkness factors are more than {}", model.lights.size(), factors.size(),
                            kMaxLights));
  }

  BallModel ball;
  std::vector<Textures> samples;
  Textures main;
  for (const SamplePatch& patch : model.samples) {
    const Codes codes = codes_of(model, patch);
    if (codes.size() < 9) return fail("the learned ball is too small: 4 pixels across are needed");
    samples.push_back(textures_of(codes, patch.light));
    const Textures some = main_textures(of_its_color(codes), patch.light);
    main.insert(main.end(), some.begin(), some.end());
  }
  ball.bright = model;
  ball.dark = model;
  ball.dark.lights.clear();
  for (const double factor : factors) {
    for (const Light& light : model.lights) {
      const auto darker = [factor](double channel) { return std::max(kDarkestLight, factor * channel); };
      ball.dark.lights.push_back({darker(light.r), darker(light.g), darker(light.b)});
    }
  }
  set_histograms(samples, ball.bright);
  set_histograms(samples, ball.dark);
  const std::vector<Depth> depths = depths_of({factors.begin(), factors.end()});
  for (const double factor : factors) {
    const auto of = std::ranges::find(depths, factor, &Depth::factor);
    ball.dark_kinds.push_back(of->kind);
  }
  const double reach = half_step(model.lights);
  for (const Light& light : model.lights) ball.of_code.push_back(kinds_of_codes(main, light, reach, depths));
  ball.diameter_px = 0.5 * (model.object_box.width + model.object_box.height);
  return ball;
}

}  // namespace cgsr::color
