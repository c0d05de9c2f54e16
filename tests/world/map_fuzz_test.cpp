// Whatever a map's file holds, it is read or refused with its name, and what is read is sound; nothing crashes.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/sha.h>

#include "pipeline/world/compact.h"
#include "pipeline/world/load.h"
#include "tests/world/map_texts.h"
#include "tests/world/scratch.h"

namespace cgsr::world {
namespace {

using testing::HasSubstr;

// One to four changes to the bytes from `from` on: a byte, a digit or bracket, a piece lost or there twice, a large number, the end cut off.
void damage(std::string& text, std::size_t from, std::mt19937& random) {
  const std::uint32_t changes = 1 + random() % 4U;
  for (std::uint32_t i = 0; i < changes && text.size() > from; ++i) {
    const std::size_t at = from + random() % (text.size() - from);
    switch (random() % 6U) {
      case 0:
        text[at] = static_cast<char>(random() % 256U);
        break;
      case 1:
        text[at] = "0123456789-+.e {}[]\",:\n"[random() % 23U];
        break;
      case 2:
        text.erase(at, 1 + random() % 8U);
        break;
      case 3:
        text.insert(at, text.substr(random() % text.size(), random() % 12U));
        break;
      case 4:
        text.insert(at, "9999999");
        break;
      default:
        if (random() % 8U == 0) text.resize(at);
        break;
    }
  }
  if (text.empty()) text = "v";
}

std::string little_endian(std::size_t value) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFFU);
  return bytes;
}

// kGltf with its numbers in the binary part, where .glb has them.
std::string json_of_glb() {
  std::string json = kGltf;
  const std::size_t uri = json.find(",\"uri\"");
  json.erase(uri, json.find("\"}", uri) + 1 - uri);
  return json;
}

// A .glb of this JSON and the four corners and two triangles of kGltf, with right lengths.
std::string glb_of(std::string json) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string numbers;
  for (const float value : {0.F, 0.F, 0.F, 2.F, 0.F, 0.F, 2.F, 0.F, 1.F, 0.F, 0.F, 1.F})
    numbers += little_endian(std::bit_cast<std::uint32_t>(value));
  for (const char index : {0, 1, 2, 0, 2, 3}) numbers += {index, '\0'};
  return "glTF" + little_endian(2) + little_endian(28 + json.size() + numbers.size()) + little_endian(json.size()) +
         "JSON" + json + little_endian(numbers.size()) + std::string("BIN\0", 4) + numbers;
}

constexpr std::size_t kCompactHead_bytes = 64;
constexpr std::size_t kCompactDigest = 32;  // offset of SHA-256 of all that follows the head

void put_digest(std::string& compact) {
  const std::string rest = compact.substr(kCompactHead_bytes);
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(rest.data()), rest.size(), digest);
  std::copy(std::begin(digest), std::end(digest), compact.begin() + kCompactDigest);
}

// What a trial writes: the format's own text damaged; half of the containers are right again around what is damaged, so that the damage gets
// past their lengths and checksums.
std::string damaged(const std::string& name, const std::string& seed, int trial, std::mt19937& random) {
  const bool inside = trial % 2 == 0;
  std::string text = seed;
  if (name == "a.glb" && inside) {
    text = json_of_glb();
    damage(text, 0, random);
    return glb_of(text);
  }
  if (name == "a.cgsrmap" && inside) {
    for (std::uint32_t i = 0; i <= random() % 4U; ++i) {  // in place: the counts of the head still fit
      text[kCompactHead_bytes + random() % (text.size() - kCompactHead_bytes)] = static_cast<char>(random() % 256U);
    }
    put_digest(text);
    return text;
  }
  damage(text, 0, random);
  return text;
}

std::string seed_of(const std::string& name, const ScratchFolder& scratch) {
  if (name == "a.cao") return kCao;
  if (name == "a.gltf") return kGltf;
  if (name == "a.glb") return glb_of(json_of_glb());
  if (name == "a.obj") return kObj;
  EXPECT_TRUE(write_compact(small_map(), scratch / name));
  return text_of(scratch / name);
}

void expect_sound(const Map& map) {
  EXPECT_FALSE(map.surfaces.empty());
  for (const Edge& edge : map.edges) {
    ASSERT_LT(std::max(edge.vertices[0], edge.vertices[1]), map.vertices.size());
    ASSERT_TRUE(edge.surfaces[0] < map.surfaces.size() || edge.kind == EdgeKind::kDrawn);
  }
  for (const Triangle& triangle : map.triangles) {
    for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, map.vertices.size());
  }
  for (const Surface& surface : map.surfaces) ASSERT_LT(surface.material, map.materials.size());
  for (const Eigen::Vector3f& p : map.vertices) ASSERT_TRUE(p.allFinite());
}

class LoadMapFuzz : public testing::TestWithParam<const char*> {};

TEST_P(LoadMapFuzz, DamagedFilesAreReadOrRefused) {
  const ScratchFolder scratch;
  const std::string name = GetParam();
  const std::string seed = seed_of(name, scratch);
  write(scratch / "small.mtl", kMtl);
  std::mt19937 random(11);
  int read = 0;
  constexpr int kTrials = 500;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    write(scratch / name, damaged(name, seed, trial, random));
    const auto map = load_map(scratch / name);
    if (!map) {
      EXPECT_THAT(map.error().message, HasSubstr("a."));
      continue;
    }
    ++read;
    expect_sound(*map);
  }
  EXPECT_GT(read, kTrials / 50) << "the damage is so coarse that it tests nothing";
  EXPECT_LT(read, kTrials * 49 / 50) << "the damage is so small that it tests nothing";
}

INSTANTIATE_TEST_SUITE_P(Files, LoadMapFuzz, testing::Values("a.obj", "a.cao", "a.gltf", "a.glb", "a.cgsrmap"),
                         [](const auto& file) { return std::string(file.param).substr(2); });

}  // namespace
}  // namespace cgsr::world
