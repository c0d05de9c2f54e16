#include "hal/sim/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kTile = 16;
constexpr float kJump = 0.12F;        // relative change of brightness that makes an edge
constexpr float kDark_cd_m2 = 0.15F;  // below this, changes do not matter

// Rotated grids: every sample in a row and a column of its own.
constexpr std::array<float, 4> kFourX{-0.125F, 0.375F, -0.375F, 0.125F};
constexpr std::array<float, 4> kFourY{-0.375F, -0.125F, 0.125F, 0.375F};

Vector2f sample_offset(int index, int count) {
  if (count == 4) return {kFourX[static_cast<std::size_t>(index)], kFourY[static_cast<std::size_t>(index)]};
  const int column = index % 4;
  const int row = index / 4;
  return {(static_cast<float>(column * 4 + row) + 0.5F) / 16.0F - 0.5F,
          (static_cast<float>(row * 4 + (3 - column)) + 0.5F) / 16.0F - 0.5F};
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::make(const Scene& scene, const CameraModel& camera,
                                                 const RenderOptions& options) {
  if (camera.width_px < 2 || camera.height_px < 1 || camera.width_px > 8192 || camera.height_px > 8192) {
    return fail(fmt::format("an image of {} x {} pixels is not drawn", camera.width_px, camera.height_px));
  }
  if (options.threads < 1 || options.threads > 64)
    return fail(fmt::format("{} threads are not in 1..64", options.threads));
  if (options.edge_samples != 1 && options.edge_samples != 4 && options.edge_samples != 16) {
    return fail(fmt::format("edge_samples = {} is not 1, 4 or 16", options.edge_samples));
  }
  auto tracer = Tracer::make(scene);
  if (!tracer) return tl::unexpected(tracer.error());
  return std::unique_ptr<Renderer>(new Renderer(scene, camera, options, std::move(*tracer)));
}

Renderer::Renderer(const Scene& scene, const CameraModel& camera, const RenderOptions& options,
                   std::unique_ptr<Tracer> tracer)
    : scene_(scene),
      camera_(camera),
      options_(options),
      workers_(options.threads),
      rays_(camera),
      tracer_(std::move(tracer)),
      surfaces_(scene),
      shader_(scene, *tracer_, surfaces_) {
  if (scene.ambient.corner_reach_m > 0.0)
    OpenBaker(scene_, *tracer_, surfaces_).bake(scene.ambient.corner_reach_m, workers_);
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  geometry_.width_px = camera.width_px;
  geometry_.height_px = camera.height_px;
  geometry_.part.resize(pixels);
  geometry_.polygon.resize(pixels);
  geometry_.depth_m.resize(pixels);
  brightness_.resize(pixels);
  tiles_across_ = (camera.width_px + kTile - 1) / kTile;
  tiles_ = tiles_across_ * ((camera.height_px + kTile - 1) / kTile);
}

void Renderer::draw(const SceneState& state, const Pose& X_WC, RadianceImage& image) {
  tracer_->update(state);
  shader_.set_state(state);
  image.width_px = camera_.width_px;
  image.height_px = camera_.height_px;
  image.rgb.resize(brightness_.size() * 3);
  workers_.run(tiles_, [&](int tile) { first_pass(tile, X_WC, image); });
  if (options_.edge_samples > 1) workers_.run(tiles_, [&](int tile) { edge_pass(tile, X_WC, image); });
}

void Renderer::first_pass(int tile, const Pose& X_WC, RadianceImage& image) {
  const Eigen::Matrix3f R = X_WC.linear().cast<float>();
  const int left = tile % tiles_across_ * kTile;
  const int top = tile / tiles_across_ * kTile;
  const int right = std::min(left + kTile, camera_.width_px);
  const int bottom = std::min(top + kTile, camera_.height_px);
  Bundle bundle;
  bundle.origin = X_WC.translation().cast<float>();
  bundle.width = static_cast<float>(1.0 / camera_.fx_px);
  std::array<std::size_t, kPacket> pixel{};
  for (int y = top; y < bottom; y += 2) {
    for (int x = left; x < right; x += 4) {
      bundle.count = 0;
      for (int row = y; row < std::min(y + 2, bottom); ++row) {
        for (int column = x; column < std::min(x + 4, right); ++column) {
          const auto lane = static_cast<std::size_t>(bundle.count++);
          pixel[lane] = static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width_px) +
                        static_cast<std::size_t>(column);
          bundle.direction[lane] = R * rays_.direction(column, row, Vector2f::Zero());
          bundle.seed[lane] = static_cast<std::uint32_t>(pixel[lane]);
        }
      }
      shader_.shade(bundle, true);
      for (std::size_t lane = 0; lane < static_cast<std::size_t>(bundle.count); ++lane) {
        const Surfel& surfel = bundle.surfel[lane];
        const std::size_t at = pixel[lane];
        geometry_.part[at] = surfel.part;
        geometry_.polygon[at] = surfel.polygon;
        geometry_.depth_m[at] = surfel.depth_m;
        brightness_[at] = bundle.radiance[lane].sum();
        Eigen::Map<Rgb>(&image.rgb[at * 3]) = bundle.radiance[lane];
      }
    }
  }
}

bool Renderer::differ(std::size_t a, std::size_t b) const {
  if (geometry_.part[a] != geometry_.part[b]) return true;
  const auto part = static_cast<std::size_t>(geometry_.part[a]);
  if (geometry_.part[a] >= 0 && geometry_.polygon[a] != geometry_.polygon[b] && !scene_.parts[part].mesh.smooth)
    return true;
  const float sum = brightness_[a] + brightness_[b];
  return std::abs(brightness_[a] - brightness_[b]) > kJump * 0.5F * (sum + 2.0F * kDark_cd_m2);
}

bool Renderer::is_edge(int x, int y) const {
  const auto width = static_cast<std::size_t>(camera_.width_px);
  const std::size_t at = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
  return (x > 0 && differ(at, at - 1)) || (x + 1 < camera_.width_px && differ(at, at + 1)) ||
         (y > 0 && differ(at, at - width)) || (y + 1 < camera_.height_px && differ(at, at + width));
}

void Renderer::edge_pass(int tile, const Pose& X_WC, RadianceImage& image) {
  const int left = tile % tiles_across_ * kTile;
  const int top = tile / tiles_across_ * kTile;
  std::vector<int> edges;
  for (int y = top; y < std::min(top + kTile, camera_.height_px); ++y) {
    for (int x = left; x < std::min(left + kTile, camera_.width_px); ++x) {
      if (is_edge(x, y)) edges.push_back(y * camera_.width_px + x);
    }
  }
  refine(edges, X_WC, image);
}

// Draws the pixels again with several rays each: two pixels of four rays to a packet, or half a pixel of sixteen.
void Renderer::refine(const std::vector<int>& pixels, const Pose& X_WC, RadianceImage& image) const {
  const Eigen::Matrix3f R = X_WC.linear().cast<float>();
  const int samples = options_.edge_samples;
  Bundle bundle;
  bundle.origin = X_WC.translation().cast<float>();
  bundle.width = static_cast<float>(1.0 / camera_.fx_px / std::sqrt(static_cast<double>(samples)));
  std::array<std::size_t, kPacket> pixel{};
  const auto flush = [&] {
    shader_.shade(bundle, true);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(bundle.count); ++lane) {
      Eigen::Map<Rgb>(&image.rgb[pixel[lane] * 3]) += bundle.radiance[lane] / static_cast<float>(samples);
    }
    bundle.count = 0;
  };
  for (const int at : pixels) {
    Eigen::Map<Rgb>(&image.rgb[static_cast<std::size_t>(at) * 3]).setZero();
    for (int i = 0; i < samples; ++i) {
      const auto lane = static_cast<std::size_t>(bundle.count++);
      pixel[lane] = static_cast<std::size_t>(at);
      bundle.direction[lane] =
          R * rays_.direction(at % camera_.width_px, at / camera_.width_px, sample_offset(i, samples));
      bundle.seed[lane] = mix(static_cast<std::uint32_t>(at), static_cast<std::uint32_t>(i));
      if (bundle.count == kPacket) flush();
    }
  }
  if (bundle.count > 0) flush();
}

}  // namespace cgsr::sim
