#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/world/small_maps.h"

namespace cgsr::world {

// A small map in each of the formats that load_map() reads.
inline constexpr const char* kObj = R"(# an L of two materials, and a wall
mtllib small.mtl
o floor
usemtl wood
v 0 0 0
v 3 0 0
v 3 1 0
v 1 1 0
v 1 3 0
v 0 3 0
f 1 2 3 4 5 6
o wall
usemtl paint
v 0 0 0
v 3 0 0
v 3 0 2
v 0 0 2
f 7 8 9 10
usemtl nowhere
v 5 5 0
v 6 5 0
v 6 6 0
f -3 -2 -1
)";
inline constexpr const char* kMtl = "newmtl wood\nKd 0.6 0.4 0.2\nnewmtl paint\nKd 0.9 0.9 0.9\n";

inline constexpr const char* kCao = R"(V1
# 3D points
5
0 0 0
1 0 0 # a comment
1 1 0
0 1 0 name=corner
0.5 0.5 1
# 3D lines
6
0 1
1 2
2 3 name=back useLod=true minLineLengthThreshold=50
3 0
0 4
1 3
# faces from lines
1
4 0 1 2 3 name=base
# faces from points
1
3 0 1 4
0
0
)";

inline constexpr const char* kGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"translation":[0,1,0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0}]}],
"materials":[{"name":"green","pbrMetallicRoughness":{"baseColorFactor":[0.0,0.5,0.0,1.0]}}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[2,0,1]},
{"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
"buffers":[{"byteLength":60,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAQAAAAAAAAIA/AAAAAAAAAAAAAIA/AAABAAIAAAACAAMA"}]})";

/// A floor with a box and a drawn line.
inline Map small_map() {
  Maker maker;
  maker.material("floor", 0.4F);
  maker.material("box", 0.9F);
  maker.level(-2, -2, 2, 2, 0, 0);
  maker.box({0, 0, 0.001F}, {0.5F, 0.4F, 0.3F}, 1);
  maker.line({-1, -1, 0}, {1, -1, 0});
  return maker.map();
}

inline void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace cgsr::world
