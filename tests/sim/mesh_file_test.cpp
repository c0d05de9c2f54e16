#include "hal/sim/worlds/mesh_file.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/sim/scene/map_count.h"
#include "hal/sim/scene/portable_math.h"
#include "hal/sim/scene/scene.h"
#include "tests/support/scratch_folder.h"

namespace cgsr::sim {
namespace {

using testing::HasSubstr;

class MeshFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

 private:
  cgsr::test::ScratchFolder folder_;
};

const std::string kCube =
    "mtllib cube.mtl\no cube\n"
    "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nv 0 0 100\nv 100 0 100\nv 100 100 100\nv 0 100 100\n"
    "usemtl red\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nusemtl grey\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST_F(MeshFile, ObjKeepsItsQuadsUnitsAndColours) {
  write("cube.mtl", "newmtl red\nKd 0.8 0.1 0.1\nnewmtl grey\nKd 0.5 0.5 0.5\nPr 0.4\nKs 0.5 0.5 0.5\n");
  const auto pieces = read_mesh_file(write("cube.obj", kCube), 0.01);
  ASSERT_TRUE(pieces) << pieces.error().message;
  ASSERT_EQ(pieces->size(), 2U);
  Scene scene;
  Eigen::AlignedBox3f box;
  for (const FilePiece& piece : *pieces) {
    scene.add_static(piece.name, piece.mesh, scene.add_material(piece.material));
    box.extend(bounds(piece.mesh));
  }
  const MapCount count = count_map(scene);
  EXPECT_EQ(count.surfaces, 6);
  EXPECT_EQ(count.edges, 12);
  EXPECT_LT((box.sizes() - Eigen::Vector3f::Ones()).norm(), 1e-5F) << "centimetres";
  const auto& red = scene.materials[0].name == "red" ? scene.materials[0] : scene.materials[1];
  EXPECT_LT((red.albedo - from_srgb({0.8, 0.1, 0.1})).norm(), 1e-4F);
  const auto& grey = scene.materials[0].name == "red" ? scene.materials[1] : scene.materials[0];
  EXPECT_NEAR(grey.roughness, 0.4F, 1e-5F);
}

TEST_F(MeshFile, GltfIsTurnedFromYUpToZUp) {
  // One triangle in the xy plane of the file, 1 m wide and 2 m high; base64 of three float triples.
  const auto file =
      write("sheet.gltf",
            R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"scene":0,"nodes":[{"mesh":0,"name":"sheet"}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.25,0.5,0.75,1],"roughnessFactor":0.7,"metallicFactor":0}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0]}],
"bufferViews":[{"buffer":0,"byteLength":36}],
"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA"}]})");
  const auto pieces = read_mesh_file(file, 1.0);
  ASSERT_TRUE(pieces) << pieces.error().message;
  ASSERT_EQ(pieces->size(), 1U);
  const Eigen::AlignedBox3f box = bounds(pieces->front().mesh);
  EXPECT_LT((box.sizes() - Eigen::Vector3f(1, 0, 2)).norm(), 1e-6F);
  EXPECT_LT((pieces->front().material.albedo - Rgb(0.25F, 0.5F, 0.75F)).norm(), 1e-6F) << "linear as it is";
}

TEST_F(MeshFile, RefusesWhatHasNoSurface) {
  const auto message = [](const std::filesystem::path& file) {
    const auto pieces = read_mesh_file(file, 1.0);
    return pieces ? std::string() : pieces.error().message;
  };
  EXPECT_THAT(message("nowhere.obj"), HasSubstr("nowhere.obj: No such file"));
  EXPECT_THAT(message(write("empty.obj", "")), HasSubstr("empty.obj"));
  EXPECT_THAT(message(write("points.obj", "v 0 0 0\nv 1 0 0\n")), HasSubstr("points.obj"));
  EXPECT_THAT(message(write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")), HasSubstr("nan.obj"));
  EXPECT_THAT(message(write("far.obj", "v 0 0 0\nf 1 2 9\n")), HasSubstr("far.obj"));
  EXPECT_THAT(message(write("text.gltf", "{}")), HasSubstr("text.gltf"));
}

}  // namespace
}  // namespace cgsr::sim
