#include "hal/sim/render/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

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
      shader_(scene, *tracer_, surfaces_),
      changes_(scene) {
  if (scene.ambient.corner_reach_m > 0.0)
    OpenBaker(scene_, *tracer_, surfaces_).bake(scene.ambient.corner_reach_m, workers_);
  const auto pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  geometry_.width_px = camera.width_px;
  geometry_.height_px = camera.height_px;
  geometry_.part.resize(pixels);
  geometry_.polygon.resize(pixels);
  geometry_.depth_m.resize(pixels);
  first_.resize(3 * pixels);
  brightness_.resize(pixels);
  refined_.resize(3 * pixels);
  make_tiles();
}

void Renderer::make_tiles() {
  tiles_across_ = (camera_.width_px + kTile - 1) / kTile;
  for (int top = 0; top < camera_.height_px; top += kTile) {
    for (int left = 0; left < camera_.width_px; left += kTile) {
      Tile tile;
      tile.left = left;
      tile.top = top;
      tile.right = std::min(left + kTile, camera_.width_px);
      tile.bottom = std::min(top + kTile, camera_.height_px);
      tiles_.push_back(std::move(tile));
    }
  }
}

void Renderer::draw(const SceneState& state, const Pose& X_WC, RadianceImage& image) {
  tracer_->update(state);
  shader_.set_state(state);
  changes_.update(state, *tracer_, X_WC);
  const auto count = static_cast<int>(tiles_.size());
  workers_.run(count, [&](int index) {
    Tile& tile = tiles_[static_cast<std::size_t>(index)];
    tile.redrawn = changes_.affects(tile.first) || changes_.affects(tile.refined);
    if (tile.redrawn) first_pass(tile, X_WC);
  });
  if (options_.edge_samples > 1) workers_.run(count, [&](int index) { edge_pass(index, X_WC); });
  image.width_px = camera_.width_px;
  image.height_px = camera_.height_px;
  image.rgb = options_.edge_samples > 1 ? refined_ : first_;
}

double Renderer::traced_share() const {
  const auto traced = std::count_if(tiles_.begin(), tiles_.end(), [](const Tile& tile) { return tile.redrawn; });
  return static_cast<double>(traced) / static_cast<double>(tiles_.size());
}

void Renderer::first_pass(Tile& tile, const Pose& X_WC) {
  const Eigen::Matrix3f R = X_WC.linear().cast<float>();
  Bundle bundle;
  bundle.origin = X_WC.translation().cast<float>();
  bundle.width = static_cast<float>(1.0 / camera_.fx_px);
  std::array<std::size_t, kPacket> pixel{};
  tile.first = {};
  for (int y = tile.top; y < tile.bottom; y += 2) {
    for (int x = tile.left; x < tile.right; x += 4) {
      bundle.count = 0;
      for (int row = y; row < std::min(y + 2, tile.bottom); ++row) {
        for (int column = x; column < std::min(x + 4, tile.right); ++column) {
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
        Eigen::Map<Rgb>{&first_[at * 3]} = bundle.radiance[lane];
        tile.first.extend({bundle.origin, bundle.direction[lane], bundle.width}, surfel);
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

bool Renderer::neighbor_redrawn(int index) const {
  const auto at = static_cast<std::size_t>(index);
  const auto across = static_cast<std::size_t>(tiles_across_);
  const Tile& tile = tiles_[at];
  return (tile.left > 0 && tiles_[at - 1].redrawn) || (tile.right < camera_.width_px && tiles_[at + 1].redrawn) ||
         (tile.top > 0 && tiles_[at - across].redrawn) ||
         (tile.bottom < camera_.height_px && tiles_[at + across].redrawn);
}

std::vector<int> Renderer::edges_of(const Tile& tile) const {
  const int width = camera_.width_px;
  std::array<bool, static_cast<std::size_t>(kTile * kTile)> edge{};
  const auto mark = [&](int x, int y) {
    if (x >= tile.left && x < tile.right && y >= tile.top && y < tile.bottom)
      edge[static_cast<std::size_t>((y - tile.top) * kTile + x - tile.left)] = true;
  };
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * width + x); };
  for (int y = tile.top; y < tile.bottom; ++y) {
    for (int x = std::max(tile.left - 1, 0); x < std::min(tile.right, width - 1); ++x) {
      if (!differ(at(x, y), at(x + 1, y))) continue;
      mark(x, y);
      mark(x + 1, y);
    }
  }
  for (int y = std::max(tile.top - 1, 0); y < std::min(tile.bottom, camera_.height_px - 1); ++y) {
    for (int x = tile.left; x < tile.right; ++x) {
      if (!differ(at(x, y), at(x, y + 1))) continue;
      mark(x, y);
      mark(x, y + 1);
    }
  }
  std::vector<int> edges;
  for (int y = tile.top; y < tile.bottom; ++y) {
    for (int x = tile.left; x < tile.right; ++x) {
      if (edge[static_cast<std::size_t>((y - tile.top) * kTile + x - tile.left)]) edges.push_back(y * width + x);
    }
  }
  return edges;
}

// Which pixels are at an edge is a matter of the neighbouring tiles, too. What a pixel becomes is a matter of all of its tile that are:
// they share packets.
void Renderer::edge_pass(int index, const Pose& X_WC) {
  Tile& tile = tiles_[static_cast<std::size_t>(index)];
  if (!tile.redrawn && !neighbor_redrawn(index)) return;
  std::vector<int> edges = edges_of(tile);
  if (!tile.redrawn && edges == tile.edges) return;
  tile.edges = std::move(edges);
  for (int y = tile.top; y < tile.bottom; ++y) {
    const auto row = 3 * static_cast<std::ptrdiff_t>(y) * camera_.width_px;
    std::copy(first_.begin() + row + 3 * tile.left, first_.begin() + row + 3 * tile.right,
              refined_.begin() + row + 3 * tile.left);
  }
  refine(tile, X_WC);
}

// Draws the edges again with several rays each: two pixels of four rays to a packet, or half a pixel of sixteen.
void Renderer::refine(Tile& tile, const Pose& X_WC) {
  const Eigen::Matrix3f R = X_WC.linear().cast<float>();
  const int samples = options_.edge_samples;
  Bundle bundle;
  bundle.origin = X_WC.translation().cast<float>();
  bundle.width = static_cast<float>(1.0 / camera_.fx_px / std::sqrt(static_cast<double>(samples)));
  std::array<std::size_t, kPacket> pixel{};
  tile.refined = {};
  const auto flush = [&] {
    shader_.shade(bundle, true);
    for (std::size_t lane = 0; lane < static_cast<std::size_t>(bundle.count); ++lane) {
      Eigen::Map<Rgb>(&refined_[pixel[lane] * 3]) += bundle.radiance[lane] / static_cast<float>(samples);
      tile.refined.extend({bundle.origin, bundle.direction[lane], bundle.width}, bundle.surfel[lane]);
    }
    bundle.count = 0;
  };
  for (const int at : tile.edges) {
    Eigen::Map<Rgb>(&refined_[static_cast<std::size_t>(at) * 3]).setZero();
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
