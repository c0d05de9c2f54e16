#include "pipeline/world/compact.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <fmt/format.h>
#include <openssl/sha.h>

#include "pipeline/world/file_text.h"
#include "pipeline/world/soup.h"
#include "platform/replace_file.h"

namespace cgsr::world {
namespace {

static_assert(std::endian::native == std::endian::little, "the compact copy is little-endian");

constexpr std::string_view kMagic = "CGSRMAP";
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kMostSurfaces = kLargestFaces;
constexpr std::uint32_t kMostEdges = 2 * kLargestCorners;
constexpr std::uint32_t kMostMaterials = 1'000'000;
constexpr std::uint32_t kLongestName = 4096;

using Digest = std::array<unsigned char, SHA256_DIGEST_LENGTH>;

struct Head {
  std::array<char, 8> magic{};
  std::uint32_t version = kVersion;
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
  std::uint32_t surfaces = 0;
  std::uint32_t edges = 0;
  std::uint32_t materials = 0;
  Digest digest{};
};
static_assert(std::is_trivially_copyable_v<Head> && sizeof(Head) == 64);

Digest digest_of(std::string_view text) {
  Digest digest{};
  std::array<unsigned char, SHA256_DIGEST_LENGTH>& out = digest;
  SHA256(std::bit_cast<const unsigned char*>(text.data()), text.size(), out.data());
  return digest;
}

class Writer {
 public:
  template <class Number>
  void put(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(Number));
    text_.append(bytes.data(), bytes.size());
  }
  void put(const Eigen::Vector3f& v) {
    for (int i = 0; i < 3; ++i) put(v[i]);
  }
  template <std::size_t N>
  void put(const std::array<std::uint32_t, N>& values) {
    for (const std::uint32_t v : values) put(v);
  }
  void put(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    text_.append(text);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Reads beyond the end give zeros and are noted.
class Taker {
 public:
  explicit Taker(std::string_view text) : text_(text) {}

  template <class Number>
  void take(Number& value) {
    static_assert(std::is_arithmetic_v<Number>);
    if (text_.size() < sizeof(Number)) {
      short_ = true;
      value = {};
      return;
    }
    std::memcpy(&value, text_.data(), sizeof(Number));
    text_.remove_prefix(sizeof(Number));
  }
  void take(Eigen::Vector3f& v) {
    for (int i = 0; i < 3; ++i) take(v[i]);
  }
  template <std::size_t N>
  void take(std::array<std::uint32_t, N>& values) {
    for (std::uint32_t& v : values) take(v);
  }
  void take(std::string& text) {
    std::uint32_t size = 0;
    take(size);
    if (size > kLongestName || size > text_.size()) {
      short_ = true;
      return;
    }
    text.assign(text_.substr(0, size));
    text_.remove_prefix(size);
  }
  [[nodiscard]] bool cut_short() const { return short_; }
  [[nodiscard]] std::size_t left() const { return text_.size(); }

 private:
  std::string_view text_;
  bool short_ = false;
};

bool below(std::span<const std::uint32_t> indices, std::size_t count, bool none_allowed) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](std::uint32_t i) { return i < count || (none_allowed && i == kNone); });
}

// What the file's numbers must hold to, so that nothing that uses the map reads beyond its arrays.
Result<void> check(const Map& map) {
  for (const Eigen::Vector3f& p : map.vertices) {
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kLargestExtent_m)
      return fail("a vertex is not finite or too far away");
  }
  for (const Triangle& triangle : map.triangles) {
    if (!below(triangle, map.vertices.size(), false)) return fail("a triangle names a vertex that there is not");
  }
  std::uint64_t next = 0;
  for (const Surface& surface : map.surfaces) {
    if (surface.first_triangle != next) return fail("the surfaces' triangles do not follow each other");
    next += surface.triangle_count;
    if (surface.material >= map.materials.size()) return fail("a surface names a material that there is not");
    if (!surface.normal.allFinite() || std::abs(surface.normal.norm() - 1.0F) > 1e-3F ||
        !std::isfinite(surface.offset_m))
      return fail("a surface's normal is not one");
  }
  if (next != map.triangles.size()) return fail("the surfaces' triangles are not all of them");
  for (const Edge& edge : map.edges) {
    if (!below(edge.vertices, map.vertices.size(), false)) return fail("an edge names a vertex that there is not");
    if (!below(edge.surfaces, map.surfaces.size(), true) || !below(edge.sides, map.surfaces.size(), true))
      return fail("an edge names a surface that there is not");
    if (edge.surfaces[0] == kNone && edge.kind != EdgeKind::kDrawn) return fail("an edge has no surface");
    if (!(edge.contrast >= 0.0F && edge.contrast <= 2.0F)) return fail("an edge's contrast is not one");
  }
  for (const Material& material : map.materials) {
    if (!material.color.allFinite()) return fail("a material's colour is not finite");
  }
  if (map.surfaces.empty()) return fail("there is no surface in it");
  return {};
}

std::string body_of(const Map& map) {
  Writer body;
  for (const Eigen::Vector3f& p : map.vertices) body.put(p);
  for (const Triangle& triangle : map.triangles) body.put(triangle);
  for (const Surface& surface : map.surfaces) {
    body.put(surface.first_triangle);
    body.put(surface.triangle_count);
    body.put(surface.material);
    body.put(surface.normal);
    body.put(surface.offset_m);
    body.put(static_cast<std::uint8_t>(surface.one_sided ? 1 : 0));
  }
  for (const Edge& edge : map.edges) {
    body.put(edge.vertices);
    body.put(edge.surfaces);
    body.put(edge.sides);
    body.put(edge.contrast);
    body.put(static_cast<std::uint8_t>(edge.kind));
  }
  for (const Material& material : map.materials) {
    body.put(std::string_view(material.name).substr(0, kLongestName));
    body.put(material.color);
    body.put(static_cast<std::uint8_t>(material.known_color ? 1 : 0));
  }
  return body.text();
}

Result<Map> map_in(const Head& head, std::string_view text) {
  Map map;
  Taker body(text);
  map.vertices.resize(head.vertices);
  for (Eigen::Vector3f& p : map.vertices) body.take(p);
  map.triangles.resize(head.triangles);
  for (Triangle& triangle : map.triangles) body.take(triangle);
  map.surfaces.resize(head.surfaces);
  for (Surface& surface : map.surfaces) {
    body.take(surface.first_triangle);
    body.take(surface.triangle_count);
    body.take(surface.material);
    body.take(surface.normal);
    body.take(surface.offset_m);
    std::uint8_t one_sided = 0;
    body.take(one_sided);
    surface.one_sided = one_sided != 0;
  }
  map.edges.resize(head.edges);
  for (Edge& edge : map.edges) {
    std::uint8_t kind = 0;
    body.take(edge.vertices);
    body.take(edge.surfaces);
    body.take(edge.sides);
    body.take(edge.contrast);
    body.take(kind);
    if (kind > static_cast<std::uint8_t>(EdgeKind::kDrawn)) return fail(fmt::format("an edge is of kind {}", kind));
    edge.kind = static_cast<EdgeKind>(kind);
  }
  map.materials.resize(head.materials);
  for (Material& material : map.materials) {
    std::uint8_t known = 0;
    body.take(material.name);
    body.take(material.color);
    body.take(known);
    material.known_color = known != 0;
  }
  if (body.cut_short()) return fail("it is cut short");
  if (body.left() > 0) return fail(fmt::format("{} bytes more than it says", body.left()));
  return map;
}

}  // namespace

Result<void> write_compact(const Map& map, const std::filesystem::path& path) {
  const std::string body = body_of(map);
  Head head;
  std::copy(kMagic.begin(), kMagic.end(), head.magic.begin());
  head.vertices = static_cast<std::uint32_t>(map.vertices.size());
  head.triangles = static_cast<std::uint32_t>(map.triangles.size());
  head.surfaces = static_cast<std::uint32_t>(map.surfaces.size());
  head.edges = static_cast<std::uint32_t>(map.edges.size());
  head.materials = static_cast<std::uint32_t>(map.materials.size());
  head.digest = digest_of(body);
  std::array<char, sizeof(Head)> first{};
  std::memcpy(first.data(), &head, sizeof(Head));
  return replace_file(path, {std::string_view(first.data(), first.size()), body});
}

Result<Map> read_compact(const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& what) { return fail(fmt::format("{}: {}", path.string(), what)); };
  const auto text = read_text(path);
  if (!text) return tl::unexpected(text.error());
  Head head;
  if (text->size() < sizeof(Head)) return wrong("it is too short to be a compact map");
  std::memcpy(&head, text->data(), sizeof(Head));
  if (!std::equal(kMagic.begin(), kMagic.end(), head.magic.begin())) return wrong("it is not a compact map of ours");
  if (head.version != kVersion)
    return wrong(fmt::format("version {}: expected {}; import the original again", head.version, kVersion));
  if (head.vertices > kLargestCorners || head.triangles > kLargestCorners || head.surfaces > kMostSurfaces ||
      head.edges > kMostEdges || head.materials > kMostMaterials) {
    return wrong(
        fmt::format("{} vertices, {} triangles, {} surfaces, {} edges, {} materials are more than there may be",
                    head.vertices, head.triangles, head.surfaces, head.edges, head.materials));
  }
  const std::string_view body = std::string_view(*text).substr(sizeof(Head));
  const std::uint64_t least = 12ULL * head.vertices + 12ULL * head.triangles + 29ULL * head.surfaces +
                              29ULL * head.edges + 17ULL * head.materials;
  if (body.size() < least)
    return wrong(fmt::format("it is cut short: {} bytes, expected at least {}", body.size(), least));
  if (digest_of(body) != head.digest) return wrong("the checksum does not fit: it was damaged");
  auto map = map_in(head, body);
  if (!map) return wrong(map.error().message);
  if (auto good = check(*map); !good) return wrong(good.error().message);
  return map;
}

}  // namespace cgsr::world
