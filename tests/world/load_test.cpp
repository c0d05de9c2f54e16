#include "pipeline/world/load.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/world/cao.h"
#include "pipeline/world/compact.h"
#include "tests/world/map_texts.h"
#include "tests/world/scratch.h"
#include "tests/world/small_maps.h"

namespace cgsr::world {
namespace {

using testing::HasSubstr;

/// The message that a file of this text is refused with; empty when it is not.
std::string refusal(const std::string& name, const std::string& text) {
  const ScratchFolder scratch;
  write(scratch / name, text);
  const auto map = load_map(scratch / name);
  return map ? "" : map.error().message;
}

TEST(LoadMap, ObjWithItsMaterials) {
  const ScratchFolder scratch;
  write(scratch / "small.obj", kObj);
  write(scratch / "small.mtl", kMtl);
  const auto map = load_map(scratch / "small.obj");
  ASSERT_TRUE(map) << map.error().message;
  ASSERT_EQ(map->surfaces.size(), 3U);
  const Edge foot = edge_between(*map, {0, 0, 0}, {3, 0, 0});
  EXPECT_EQ(foot.kind, EdgeKind::kCrease);
  const std::size_t wood = material_of(*map, foot.surfaces[0]) == "wood" ? 0 : 1;
  EXPECT_EQ(material_of(*map, foot.surfaces[wood]), "wood");
  EXPECT_NEAR(*side_luma(*map, foot, static_cast<int>(wood)), 0.299F * 0.6F + 0.587F * 0.4F + 0.114F * 0.2F, 1e-5F);
  EXPECT_NEAR(area_of(*map), 5.0 + 6.0 + 0.5, 1e-5);
  EXPECT_FALSE(side_luma(*map, edge_between(*map, {5, 5, 0}, {6, 5, 0}), 0)) << "no file says what 'nowhere' is";
}

TEST(LoadMap, ObjWithoutItsMaterialsHasNoColours) {
  const ScratchFolder scratch;
  write(scratch / "small.obj", kObj);
  const auto map = load_map(scratch / "small.obj");
  ASSERT_TRUE(map) << map.error().message;
  for (const Surface& surface : map->surfaces) EXPECT_FALSE(map->materials[surface.material].known_color);
  for (const Edge& edge : map->edges) EXPECT_FLOAT_EQ(edge.contrast, 0.25F);
}

TEST(LoadMap, AxesAndUnitsAreAsAskedFor) {
  const ScratchFolder scratch;
  write(scratch / "small.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4\n");
  LoadOptions options;
  options.up = UpAxis::kY;
  options.scale = 0.5;
  const auto map = load_map(scratch / "small.obj", options);
  ASSERT_TRUE(map) << map.error().message;
  edge_between(*map, {0, 0, 0}, {0, 0, 1});
  edge_between(*map, {0.5F, 0, 0}, {0.5F, 0, 1});
  EXPECT_NEAR(map->surfaces[0].normal.y(), -1.0F, 1e-6F) << "its front looked along z, which is -y now";
}

TEST(LoadMap, GltfIsTurnedUpright) {
  const ScratchFolder scratch;
  write(scratch / "small.gltf", kGltf);
  const auto map = load_map(scratch / "small.gltf");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->surfaces.size(), 1U);
  EXPECT_EQ(map->edges.size(), 4U);
  edge_between(*map, {0, 0, 1}, {2, 0, 1});
  edge_between(*map, {2, 0, 1}, {2, -1, 1});
  EXPECT_NEAR(map->materials[map->surfaces[0].material].color.y(), 0.7354F, 1e-3F) << "0.5 linear is 0.735 in sRGB";
}

TEST(LoadMap, CaoWithItsLinesAndFaces) {
  const ScratchFolder scratch;
  write(scratch / "small.cao", kCao);
  const auto map = load_map(scratch / "small.cao");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->surfaces.size(), 2U);
  EXPECT_EQ(map->edges.size(), 7U);
  EXPECT_EQ(count(*map, EdgeKind::kDrawn), 1);
  EXPECT_EQ(edge_between(*map, {1, 0, 0}, {0, 1, 0}).kind, EdgeKind::kDrawn);
  EXPECT_EQ(edge_between(*map, {0, 0, 0}, {1, 0, 0}).kind, EdgeKind::kCrease);
}

TEST(LoadMap, FacesOfACaoAreSeenFromTheirFrontAlone) {
  const ScratchFolder scratch;
  write(scratch / "small.cao", kCao);
  write(scratch / "sheet.cao",
        "V1\n5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n0\n0\n3\n4 0 1 2 3\n4 3 2 1 0\n3 0 1 4\n0\n0\n");
  write(scratch / "sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const auto small = load_map(scratch / "small.cao");
  const auto both_ways = load_map(scratch / "sheet.cao");
  const auto obj = load_map(scratch / "sheet.obj");
  ASSERT_TRUE(small && both_ways && obj);
  for (const Surface& surface : small->surfaces) EXPECT_TRUE(surface.one_sided);
  for (const Surface& surface : obj->surfaces) EXPECT_FALSE(surface.one_sided);
  ASSERT_EQ(both_ways->surfaces.size(), 2U);
  for (const Surface& surface : both_ways->surfaces)
    EXPECT_EQ(surface.one_sided, std::abs(surface.normal.z()) < 0.5F) << "given front and back";
}

TEST(LoadMap, AnEdgeIsSeenWhereOneOfItsSurfacesIs) {
  Maker maker;
  maker.box({0, 0, 0}, {1, 1, 1});
  Map map = maker.map();
  const Edge edge = edge_between(map, {0, 0, 1}, {1, 0, 1});
  EXPECT_TRUE(is_seen_from(map, edge, {0.5F, 2.0F, 0.5F}));
  for (Surface& surface : map.surfaces) surface.one_sided = true;
  EXPECT_FALSE(is_seen_from(map, edge, {0.5F, 2.0F, 0.5F}));
  EXPECT_TRUE(is_seen_from(map, edge, {0.5F, 2.0F, 1.5F})) << "the top";
  EXPECT_TRUE(is_seen_from(map, edge, {0.5F, -2.0F, 0.5F})) << "the front";
  EXPECT_TRUE(is_seen_from(map, Edge(), {0.5F, 2.0F, 0.5F})) << "no surface";
}

TEST(LoadMap, CaoLoadsOthersWhereItPlacesThem) {
  const ScratchFolder scratch;
  write(scratch / "small.cao", kCao);
  write(scratch / "both.cao",
        "V1\n# others first\nload(\"small.cao\")\nload(\"small.cao\", t=[0; 0; 5], tu=[0; 0; 1.5707963267948966])\n"
        "3\n10 0 0\n11 0 0\n11 1 0\n0\n0\n1\n3 0 1 2\n0\n0\n");
  const auto map = load_map(scratch / "both.cao");
  ASSERT_TRUE(map) << map.error().message;
  EXPECT_EQ(map->surfaces.size(), 5U);
  EXPECT_EQ(map->edges.size(), 7U + 7U + 3U);
  edge_between(*map, {0, 0, 5}, {0, 1, 5});
  edge_between(*map, {10, 0, 0}, {11, 0, 0});
}

TEST(LoadMapFault, CaoSaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal("a.cao", "8\n"), HasSubstr("a.cao:1: '8': a .cao file begins with V1"));
  EXPECT_THAT(refusal("a.cao", ""), HasSubstr("begins with V1"));
  EXPECT_THAT(refusal("a.cao", "V1\n2\n0 0 0\n1 x 0\n"), HasSubstr("a.cao:4: 'x' where a point's coordinate"));
  EXPECT_THAT(refusal("a.cao", "V1\n2\n0 0 0\n1 0\n"), HasSubstr("the file ends where a point's coordinate"));
  EXPECT_THAT(refusal("a.cao", "V1\n2\n0 0 0\n1 nan 0\n"), HasSubstr("nan is not a coordinate"));
  EXPECT_THAT(refusal("a.cao", "V1\n2\n0 0 0\n1 0 0\n1\n0 2\n"), HasSubstr("a.cao:6: point 2: there are 2"));
  EXPECT_THAT(refusal("a.cao", "V1\n2\n0 0 0\n1 0 0\n0\n0\n1\n3 0 1 -1\n"), HasSubstr("'-1' where point"));
  EXPECT_THAT(refusal("a.cao", "V1\n99999999\n"), HasSubstr("99999999 points: expected at most"));
  EXPECT_THAT(refusal("a.cao", "V1\n3\n0 0 0\n1 0 0\n0 1 0\n2\n0 1\n1 2\n1\n3 0 1 2\n"),
              HasSubstr("line 2: there are 2"));
  EXPECT_THAT(refusal("a.cao", "V1\n4\n0 0 0\n1 0 0\n0 1 0\n1 1 1\n3\n0 1\n1 2\n2 3\n1\n3 0 1 2\n"),
              HasSubstr("do not close"));
  EXPECT_THAT(refusal("a.cao", "V1\n0\n0\n0\n0\n0\n0\n"), HasSubstr("no surface"));
  EXPECT_THAT(refusal("a.cao", "V1\n0\n0\n0\n0\n1\n0 1 0.5\n"), HasSubstr("1 cylinders: cylinders are not read"));
  EXPECT_THAT(refusal("a.cao", "V1\n0\n0\n0\n0\n0\n2\n0.5 0 1 2\n"), HasSubstr("2 circles: circles are not read"));
  EXPECT_THAT(refusal("a.cao", "V1\nload(\"a.cao\")\n0\n0\n0\n0\n"), HasSubstr("it loads itself"));
  EXPECT_THAT(refusal("a.cao", "V1\nload(\"b.cao\")\n0\n0\n0\n0\n"), HasSubstr("(loaded in "));
  EXPECT_THAT(refusal("a.cao", "V1\nload(\"b.cao\", s=[2])\n"), HasSubstr("expected t=[x; y; z]"));
}

TEST(LoadMapFault, CaoInACircleIsRefused) {
  const ScratchFolder scratch;
  write(scratch / "a.cao", "V1\nload(\"b.cao\")\n0\n0\n0\n0\n0\n0\n");
  write(scratch / "b.cao", "V1\nload(\"./a.cao\")\n0\n0\n0\n0\n0\n0\n");
  const auto map = load_map(scratch / "a.cao");
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, HasSubstr("it loads itself"));
}

// A few lines of text that load one file again and again ask for as much memory as they like.
TEST(LoadMapFault, CaoFilesTogetherHoldNoMoreThanOneMay) {
  const ScratchFolder scratch;
  write(scratch / "small.cao", kCao);  // 5 points, 6 lines
  std::string text = "V1\n";
  for (int i = 0; i < 100; ++i) text += "load(\"small.cao\")\n";
  text += "0\n0\n0\n0\n0\n0\n";
  write(scratch / "many.cao", text);
  const auto refused = [&](const CaoLimits& limits) {
    const auto soup = read_cao(scratch / "many.cao", limits);
    return soup ? "" : soup.error().message;
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.points = 500, .lines = 600}), "");
  EXPECT_THAT(
      refused({.points = 499}),
      HasSubstr("small.cao:3: 5 points after 495 of the files before: expected at most 499 in all (loaded in "));
  EXPECT_THAT(refused({.lines = 599}), HasSubstr("6 lines after 594 of the files before: expected at most 599 in all"));
  const std::uintmax_t all = text.size() + 100 * std::string(kCao).size();
  EXPECT_EQ(refused({.bytes = all}), "");
  EXPECT_THAT(refused({.bytes = all - 1}), HasSubstr("of the files before it: expected at most"));
  EXPECT_THAT(refused({.bytes = 10}), HasSubstr("many.cao: "));
}

TEST(LoadMapFault, WhatIsNoMapIsRefusedWithItsName) {
  EXPECT_THAT(refusal("a.stl", "solid"), HasSubstr("a.stl: '.stl' is no kind of map"));
  EXPECT_THAT(refusal("a.obj", ""), HasSubstr("a.obj: "));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n"), HasSubstr("a.obj: "));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 9\n"), HasSubstr("a.obj: "));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 3e8 1 0\nf 1 2 3\n"), HasSubstr("at most 1000 km"));
  EXPECT_THAT(refusal("a.gltf", "{"), HasSubstr("a.gltf: "));
  EXPECT_THAT(refusal("a.glb", "glTF"), HasSubstr("a.glb: "));
  EXPECT_THAT(refusal("a.cgsrmap", "CGSRMAP"), HasSubstr("too short"));
  EXPECT_THAT(refusal("a.gltf", std::string(200'000, '[')), HasSubstr("nested more than"));
  EXPECT_THAT(refusal("a.glb",
                      "glTF" + std::string(8, '\0') + std::string("\x40\x0D\x03\0JSON", 8) + std::string(200'000, '[')),
              HasSubstr("nested more than"));
  const auto missing = load_map("/nowhere/at/all.obj");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("/nowhere/at/all.obj: No such file"));
}

TEST(CompactMap, ComesBackAsItWas) {
  const ScratchFolder scratch;
  Map map = small_map();
  map.surfaces[1].one_sided = true;
  ASSERT_TRUE(write_compact(map, scratch / "a.cgsrmap"));
  const auto back = load_map(scratch / "a.cgsrmap");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->vertices, map.vertices);
  EXPECT_EQ(back->triangles, map.triangles);
  ASSERT_EQ(back->surfaces.size(), map.surfaces.size());
  ASSERT_EQ(back->edges.size(), map.edges.size());
  for (std::size_t i = 0; i < map.surfaces.size(); ++i) {
    EXPECT_EQ(back->surfaces[i].first_triangle, map.surfaces[i].first_triangle);
    EXPECT_EQ(back->surfaces[i].triangle_count, map.surfaces[i].triangle_count);
    EXPECT_EQ(back->surfaces[i].material, map.surfaces[i].material);
    EXPECT_EQ(back->surfaces[i].normal, map.surfaces[i].normal);
    EXPECT_EQ(back->surfaces[i].offset_m, map.surfaces[i].offset_m);
    EXPECT_EQ(back->surfaces[i].one_sided, map.surfaces[i].one_sided);
  }
  for (std::size_t i = 0; i < map.edges.size(); ++i) {
    EXPECT_EQ(back->edges[i].vertices, map.edges[i].vertices);
    EXPECT_EQ(back->edges[i].surfaces, map.edges[i].surfaces);
    EXPECT_EQ(back->edges[i].sides, map.edges[i].sides);
    EXPECT_EQ(back->edges[i].kind, map.edges[i].kind);
    EXPECT_EQ(back->edges[i].contrast, map.edges[i].contrast);
  }
  ASSERT_EQ(back->materials.size(), 2U);
  EXPECT_EQ(back->materials[1].name, "box");
  EXPECT_EQ(back->materials[1].color, map.materials[1].color);
}

/// A folder `map` with a map, and a file beside it that is none of the map's business.
class MapFolderFault : public testing::Test {
 protected:
  MapFolderFault() {
    std::filesystem::create_directories(scratch_ / "map" / "below");
    write(scratch_ / "secret.mtl", "newmtl floor\nKd 0 0 1\n");
    write(scratch_ / "secret.cao", "password: hunter2\n");
    write(scratch_ / "secret.bin", std::string(1000, '\0'));
    std::filesystem::create_symlink("../secret.mtl", scratch_ / "map" / "link.mtl");
  }

  [[nodiscard]] std::string refusal_of(const std::string& name, const std::string& text) const {
    write(scratch_ / "map" / name, text);
    const auto map = load_map(scratch_ / "map" / name);
    return map ? "" : map.error().message;
  }

  ScratchFolder scratch_;
};

constexpr const char* kTriangle = "usemtl floor\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

TEST_F(MapFolderFault, MaterialsOutsideOfItAreNotOpened) {
  for (const std::string& name : {std::string("../secret.mtl"), std::string("link.mtl")}) {
    EXPECT_THAT(refusal_of("a.obj", "mtllib " + name + "\n" + kTriangle), HasSubstr("lies outside of the map's folder"))
        << name;
  }
  write(scratch_ / "map" / "below" / "own.mtl", "newmtl floor\nKd 0 0 1\n");
  EXPECT_EQ(refusal_of("a.obj", std::string("mtllib below/own.mtl\n") + kTriangle), "");
  EXPECT_EQ(refusal_of("a.obj", std::string("mtllib below/../below/own.mtl\n") + kTriangle), "");
}

TEST_F(MapFolderFault, ModelsOutsideOfItAreNeitherOpenedNorQuoted) {
  for (const std::string& name : {std::string("../secret.cao"), (scratch_ / "secret.cao").string()}) {
    const std::string refused = refusal_of("a.cao", "V1\nload(\"" + name + "\")\n0\n0\n0\n0\n0\n0\n");
    EXPECT_THAT(refused, HasSubstr("a.cao:2: '")) << name;
    EXPECT_THAT(refused, HasSubstr("lies outside of the map's folder"));
    EXPECT_THAT(refused, testing::Not(HasSubstr("hunter2")));
  }
}

// A header or a chunk that claims 2 GB would be allocated before it is read.
TEST(MapFault, ABinaryGltfClaimsMoreThanItHas) {
  const ScratchFolder scratch;
  const auto little = [](std::uint32_t number) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(number >> (8 * i));
    return text;
  };
  const auto refusal_of = [&](std::uint32_t file, std::uint32_t chunk) {
    const std::string json = R"({"asset":{}}    )";
    write(scratch / "a.glb", "glTF" + little(2) + little(file) + little(chunk) + "JSON" + json);
    const auto map = load_map(scratch / "a.glb");
    return map ? "" : map.error().message;
  };
  EXPECT_THAT(refusal_of(0x80000000U, 16), HasSubstr("its header claims 2147483648 bytes, the file has 36"));
  EXPECT_THAT(refusal_of(36, 0x7FFFFFF0U), HasSubstr("a chunk claims 2147483632 bytes, 16 are left in the file"));
  EXPECT_THAT(refusal_of(36, 16), testing::Not(HasSubstr("claims")));
}

TEST(CompactMapFault, WhatCannotBeWrittenIsNamed) {
  const ScratchFolder scratch;
  std::filesystem::create_directory(scratch / "b.cgsrmap");
  const auto folder = write_compact(small_map(), scratch / "b.cgsrmap");
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().message, HasSubstr("b.cgsrmap: cannot be put in place"));
  EXPECT_FALSE(write_compact(small_map(), "/nowhere/at/all.cgsrmap"));
  EXPECT_THAT(write_compact(small_map(), "/dev/full").error().message,
              HasSubstr("/dev/full: cannot be written: No space left on device"));
}

TEST(CompactMapFault, DamageIsNoticed) {
  const ScratchFolder scratch;
  ASSERT_TRUE(write_compact(small_map(), scratch / "a.cgsrmap"));
  const std::string good = text_of(scratch / "a.cgsrmap");
  std::string bad = good;
  bad[good.size() / 2] = static_cast<char>(bad[good.size() / 2] ^ 1);
  EXPECT_THAT(refusal("b.cgsrmap", bad), HasSubstr("the checksum does not fit"));
  EXPECT_THAT(refusal("b.cgsrmap", good.substr(0, good.size() - 200)), HasSubstr("cut short"));
  EXPECT_THAT(refusal("b.cgsrmap", good + "x"), HasSubstr("checksum"));
  bad = good;
  bad[8] = 7;
  EXPECT_THAT(refusal("b.cgsrmap", bad), HasSubstr("version 7: expected 2"));
  bad = good;
  bad[0] = 'X';
  EXPECT_THAT(refusal("b.cgsrmap", bad), HasSubstr("not a compact map"));
  bad = good;
  bad[15] = '\x7F';  // as many vertices as there are bytes in the world
  EXPECT_THAT(refusal("b.cgsrmap", bad), HasSubstr("more than there may be"));
}

// Indices that lead nowhere are found even under a right checksum.
TEST(CompactMapFault, NonsenseUnderARightChecksumIsRefused) {
  const auto refused = [](const Map& map) {
    const ScratchFolder scratch;
    EXPECT_TRUE(write_compact(map, scratch / "a.cgsrmap"));
    const auto back = load_map(scratch / "a.cgsrmap");
    return back ? std::string() : back.error().message;
  };
  Map map = small_map();
  map.edges[3].vertices[1] = 1000;
  EXPECT_THAT(refused(map), HasSubstr("an edge names a vertex"));
  map = small_map();
  map.edges[3].sides[1] = 1000;
  EXPECT_THAT(refused(map), HasSubstr("an edge names a surface"));
  map = small_map();
  map.triangles[3][2] = 1000;
  EXPECT_THAT(refused(map), HasSubstr("a triangle names a vertex"));
  map = small_map();
  map.surfaces[2].first_triangle += 1;
  EXPECT_THAT(refused(map), HasSubstr("do not follow"));
  map = small_map();
  map.surfaces[2].material = 9;
  EXPECT_THAT(refused(map), HasSubstr("a surface names a material"));
  map = small_map();
  map.vertices[2].x() = std::nanf("");
  EXPECT_THAT(refused(map), HasSubstr("a vertex is not finite"));
  map = small_map();
  map.surfaces[1].normal.setZero();
  EXPECT_THAT(refused(map), HasSubstr("normal"));
}

}  // namespace
}  // namespace cgsr::world
