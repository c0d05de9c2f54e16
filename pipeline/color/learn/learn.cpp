#include "pipeline/color/learn/learn.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "pipeline/color/learn/distinctiveness.h"
#include "pipeline/color/learn/sample_region.h"
#include "pipeline/imaging/reduce.h"

namespace cgsr::color {
namespace {

constexpr double kWideningStep = 0.1;
constexpr int kSmallestSide = 4;  // reduced pixels

// One sample, read as colours. `around` is recorded colour until the sample's light is taken out of it.
struct View {
  PixelRect window;
  std::vector<imaging::Rgb> textures;
  std::vector<imaging::Rgb> around;
  Light light;
};

Result<imaging::ReducedImage> coded_image(const Sample& sample, std::size_t index) {
  imaging::LabelTable codes(imaging::kColorCodes);
  std::iota(codes.begin(), codes.end(), std::uint16_t{0});
  const ImageView& image = sample.image;
  if (image.empty()) return fail(fmt::format("sample {}: the image is empty", index));
  const Box& box = sample.box;
  imaging::ReducedImage reduced(image.width_px, image.height_px);
  const int factor = imaging::reduction_for(image.width_px, image.height_px, std::min(box.width, box.height));
  if (!imaging::reduce(image, factor, codes, reduced)) {
    return fail(
        fmt::format("sample {}: a YUYV image of even width, at least 16x16, is needed; this one has {}x{} pixels",
                    index, image.width_px, image.height_px));
  }

  const bool finite =
      std::isfinite(box.x) && std::isfinite(box.y) && std::isfinite(box.width) && std::isfinite(box.height);
  const Box whole_image{0, 0, static_cast<double>(image.width_px), static_cast<double>(image.height_px)};
  const double inside = finite && !box.empty() ? intersection(box, whole_image).area() / box.area() : 0.0;
  if (inside < 0.5) {
    return fail(fmt::format("sample {}: {}the box {},{},{},{} lies outside the image of {}x{} pixels", index,
                            inside > 0.0 ? "more than half of " : "", box.x, box.y, box.width, box.height,
                            image.width_px, image.height_px));
  }
  const PixelRect rect = grown(box, 0.0, reduced);
  if (std::min(rect.width(), rect.height()) < kSmallestSide) {
    return fail(fmt::format("sample {}: the box {},{},{},{} is too small: {} pixels a side are needed", index, box.x,
                            box.y, box.width, box.height, kSmallestSide * factor));
  }
  return reduced;
}

std::vector<View> views_of(std::span<const Sample> samples, const std::vector<imaging::ReducedImage>& images,
                           double growth, const LearnParameters& parameters) {
  std::vector<View> views;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    View view;
    view.window = grown(samples[i].box, growth, images[i]);
    view.textures = colors_in(images[i], view.window);
    view.light = take_out_light(view.textures, parameters.lights.assumed);
    const PixelRect ring = grown(samples[i].box, growth + parameters.surroundings * (1.0 + 2.0 * growth), images[i]);
    view.around = colors_around(images[i], ring, view.window);
    for (auto& color : view.around) color = without_light(color, view.light);
    views.push_back(std::move(view));
  }
  return views;
}

Distinctiveness judge(const std::vector<View>& views) {
  std::vector<imaging::Rgb> all;
  for (const auto& view : views) all.insert(all.end(), view.textures.begin(), view.textures.end());
  return distinctiveness_of(all);
}

// Lines 18-25 for one kind of colours (the object's, or those around it): per light the mean of the samples' histograms.
template <class Colors>
std::vector<std::uint16_t> histogram_rows(const std::vector<View>& views, const std::vector<Light>& lights,
                                          const imaging::ColorBins& bins, Colors colors_of) {
  std::vector<std::uint16_t> rows;
  const auto with_colors =
      std::count_if(views.begin(), views.end(), [&](const View& v) { return !colors_of(v).empty(); });
  if (with_colors == 0) return rows;
  for (const auto& light : lights) {
    std::vector<double> mean(static_cast<std::size_t>(bins.count()), 0.0);
    for (const auto& view : views) {
      const auto one = histogram_under(colors_of(view), light, bins);
      for (std::size_t bin = 0; bin < mean.size(); ++bin) mean[bin] += one[bin] / static_cast<double>(with_colors);
    }
    append_counts(mean, rows);
  }
  return rows;
}

Box window_box(const PixelRect& rect, int factor) {
  return {static_cast<double>(rect.left * factor), static_cast<double>(rect.top * factor),
          static_cast<double>(rect.width() * factor), static_cast<double>(rect.height() * factor)};
}

std::string words_for(const Distinctiveness& before, const Distinctiveness& after, double growth, double needed) {
  if (growth == 0.0) {
    return fmt::format("distinctiveness {:.3f} nat (one colour explains {:.0f} % of the region; {:.3f} needed)",
                       after.divergence, 100.0 * after.max_share, needed);
  }
  return fmt::format(
      "one colour explains {:.0f} % of the box, which under some light is any plain surface (distinctiveness {:.3f} "
      "nat, "
      "{:.3f} needed): "
      "widened by {:.0f} % per side to take in surroundings, distinctiveness {:.3f} nat",
      100.0 * before.max_share, before.divergence, needed, 100.0 * growth, after.divergence);
}

}  // namespace

void append_counts(const std::vector<double>& shares, std::vector<std::uint16_t>& rows) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto scaled = [&](std::size_t bin) { return shares[bin] * kHistogramMass; };
  const auto remainder = [&](std::size_t bin) { return scaled(bin) - std::floor(scaled(bin)); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return remainder(a) > remainder(b); });

  const std::size_t first = rows.size();
  int missing = kHistogramMass;
  for (std::size_t bin = 0; bin < shares.size(); ++bin) {
    rows.push_back(static_cast<std::uint16_t>(std::floor(scaled(bin))));
    missing -= rows.back();
  }
  for (std::size_t i = 0; i < order.size() && missing > 0; ++i, --missing) ++rows[first + order[i]];
}

Light take_out_light(std::span<imaging::Rgb> colors, double assumed) {
  Light light{assumed, assumed, assumed};
  for (const auto& c : colors) {
    light = {std::max(light.r, c.r), std::max(light.g, c.g), std::max(light.b, c.b)};
  }
  for (auto& c : colors) c = without_light(c, light);
  return light;
}

std::vector<double> histogram_under(std::span<const imaging::Rgb> textures, const Light& light,
                                    const imaging::ColorBins& bins) {
  std::vector<double> shares(static_cast<std::size_t>(bins.count()), 0.0);
  for (const auto& texture : textures) {
    shares[static_cast<std::size_t>(imaging::bin_of(bins, lit(texture, light)))] +=
        1.0 / static_cast<double>(textures.size());
  }
  return shares;
}

Result<Learned> learn(std::span<const Sample> samples, const LearnParameters& parameters) {
  if (samples.empty() || samples.size() > kMaxSamples) {
    return fail(fmt::format("{} samples given, 1 to {} can be learned from", samples.size(), kMaxSamples));
  }
  const auto lights = light_grid(parameters.lights);
  if (lights.empty()) return fail("no light of the grid is plausible: check min_level, max_level and max_green_excess");
  std::vector<imaging::ReducedImage> images;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    auto image = coded_image(samples[i], i);
    if (!image) return tl::unexpected(image.error());
    images.push_back(std::move(*image));
  }

  // The multi-colour constraint: grow until the region is distinctive enough, or give up.
  double growth = 0.0;
  auto views = views_of(samples, images, growth, parameters);
  const auto at_first = judge(views);
  auto now = at_first;
  while (now.divergence < parameters.min_distinctiveness) {
    growth += kWideningStep;
    if (!parameters.widen || growth > parameters.max_widening + 1e-9) {
      return fail(
          fmt::format("one colour explains {:.0f} % of the region: under some light it is any plain surface "
                      "(distinctiveness {:.3f} nat, "
                      "{:.3f} needed){}; take in something of another colour",
                      100.0 * at_first.max_share, at_first.divergence, parameters.min_distinctiveness,
                      parameters.widen ? ", and its surroundings do not help" : ", and widening is off"));
    }
    views = views_of(samples, images, growth, parameters);
    now = judge(views);
  }

  Learned learned;
  ColorModel& model = learned.model;
  model.bins = parameters.bins;
  model.lights = lights;
  model.object = histogram_rows(views, lights, parameters.bins, [](const View& v) { return std::span(v.textures); });
  model.surroundings =
      histogram_rows(views, lights, parameters.bins, [](const View& v) { return std::span(v.around); });
  model.image_width_px = samples[0].image.width_px;
  model.image_height_px = samples[0].image.height_px;
  model.distinctiveness = now.divergence;
  const double share = 1.0 / static_cast<double>(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Box window = window_box(views[i].window, images[i].factor);
    const Box& box = samples[i].box;
    learned.windows.push_back(window);
    model.width_px += window.width * share;
    model.height_px += window.height * share;
    model.object_box.x += (box.x - window.x) * share;
    model.object_box.y += (box.y - window.y) * share;
    model.object_box.width += box.width * share;
    model.object_box.height += box.height * share;
    model.samples.push_back(cut_patch(samples[i].image, window, views[i].light));
  }
  learned.widened_by = growth;
  learned.message = words_for(at_first, now, growth, parameters.min_distinctiveness);
  return learned;
}

}  // namespace cgsr::color
