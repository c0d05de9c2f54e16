#include "pipeline/world/mesh_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include "pipeline/world/file_text.h"
#include "pipeline/world/glb_check.h"
#include "pipeline/world/map_folder.h"
#include "pipeline/world/map_io.h"

namespace cgsr::world {
namespace {

constexpr int kDeepest = 256;

float encoded(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
}

// By the name's ending, however it is written.
bool is_a(const std::filesystem::path& path, std::string_view ending) {
  const std::string own = path.extension().string();
  return std::equal(own.begin(), own.end(), ending.begin(), ending.end(),
                    [](unsigned char a, char b) { return std::tolower(a) == b; });
}

// glTF's JSON is parsed by recursion: brackets within brackets without end would take the stack.
bool too_deep(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  bool escaped = false;
  for (const char c : text) {
    if (quoted) {
      quoted = escaped || c != '"';
      escaped = !escaped && c == '\\';
      continue;
    }
    if (c == '"') quoted = true;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) return true;
  }
  return false;
}

// What is wrong with a glTF file before assimp reads it; empty: nothing. The JSON is all of a .gltf and the first chunk of a .glb (after 20
// bytes of headers, as long as the 4 from the 12th on say).
Result<std::string> gltf_problem(const std::filesystem::path& path) {
  const auto text = read_text(path);
  if (!text) return tl::unexpected(text.error());
  const std::string deep = fmt::format("brackets are nested more than {} deep", kDeepest);
  if (!is_a(path, ".glb")) return too_deep(*text) ? deep : "";
  if (std::string problem = glb_problem(*text); !problem.empty()) return problem;
  if (text->size() < 20) return "";
  std::uint32_t length = 0;
  for (std::size_t i = 0; i < 4; ++i)
    length |= static_cast<std::uint32_t>(static_cast<unsigned char>((*text)[12 + i])) << (8U * i);
  return too_deep(std::string_view(*text).substr(20, length)) ? deep : "";
}

// The first word of a line and what follows it.
std::pair<std::string_view, std::string_view> split(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::size_t end = std::min(line.find_first_of(kBlank), line.size());
  std::string_view rest = line.substr(end);
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlank), rest.size()));
  while (!rest.empty() && kBlank.find(rest.back()) != std::string_view::npos) rest.remove_suffix(1);
  return {line.substr(0, end), rest};
}

template <class Take>
void each_line(std::string_view text, const Take& take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto [word, rest] = split(text.substr(0, end));
    take(word, rest);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// The materials that an OBJ's libraries really give a Kd: assimp fills in a grey of its own for the others.
std::set<std::string, std::less<>> given_colors(const MapFolder& folder) {
  std::set<std::string, std::less<>> given;
  const auto text = read_text(folder.map());
  if (!text) return given;
  each_line(*text, [&](std::string_view word, std::string_view name) {
    if (word != "mtllib") return;
    const auto file = folder.find(folder.map().parent_path() / std::filesystem::path(name));
    if (!file) return;
    const auto library = read_text(*file);
    if (!library) return;
    std::string material;
    each_line(*library, [&](std::string_view key, std::string_view value) {
      if (key == "newmtl") material = value;
      if (key == "Kd") given.insert(material);
    });
  });
  return given;
}

Material material_of(const aiMaterial& from, bool gltf) {
  Material material;
  aiString name;
  if (from.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
  aiColor3D diffuse;
  aiColor4D base;
  if (gltf && from.Get(AI_MATKEY_BASE_COLOR, base) == AI_SUCCESS) {
    material.color = {encoded(base.r), encoded(base.g), encoded(base.b)};
  } else if (from.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) == AI_SUCCESS) {
    material.color = {diffuse.r, diffuse.g, diffuse.b};
  } else {
    material.known_color = false;
  }
  if (from.GetTextureCount(aiTextureType_DIFFUSE) > 0 || from.GetTextureCount(aiTextureType_BASE_COLOR) > 0)
    material.known_color = false;
  // The name that assimp gives to what the file does not say.
  if (material.name == AI_DEFAULT_MATERIAL_NAME) material.known_color = false;
  if (!material.color.allFinite()) material.known_color = false;
  if (!material.known_color) material.color.setConstant(0.5F);
  material.color = material.color.cwiseMax(0.0F).cwiseMin(1.0F);
  return material;
}

class Collector {
 public:
  Collector(const aiScene& scene, double scale, bool y_up, Soup& soup)
      : scene_(scene), scale_(scale), y_up_(y_up), soup_(soup) {}

  Result<void> add(const aiNode& node, const aiMatrix4x4& X_parent, int depth) {
    if (depth > kDeepest) return fail(fmt::format("nodes are nested more than {} deep", kDeepest));
    const aiMatrix4x4 X = X_parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= scene_.mNumMeshes) return fail(fmt::format("there is no mesh {}", node.mMeshes[i]));
      if (auto good = add(*scene_.mMeshes[node.mMeshes[i]], X); !good) return good;
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      if (auto good = add(*node.mChildren[i], X, depth + 1); !good) return good;
    }
    return {};
  }

 private:
  Result<void> add(const aiMesh& mesh, const aiMatrix4x4& X) {
    if (mesh.mMaterialIndex >= soup_.materials.size())
      return fail(fmt::format("there is no material {}", mesh.mMaterialIndex));
    const auto first = static_cast<std::uint32_t>(soup_.points.size());
    if (soup_.points.size() + mesh.mNumVertices > kLargestCorners)
      return fail(fmt::format("more than {} corners", kLargestCorners));
    if (soup_.faces.size() + mesh.mNumFaces > kLargestFaces)
      return fail(fmt::format("more than {} faces", kLargestFaces));
    const auto scale = static_cast<float>(scale_);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D p = X * mesh.mVertices[i];
      if (y_up_) {
        soup_.points.emplace_back(scale * p.x, -scale * p.z, scale * p.y);
      } else {
        soup_.points.emplace_back(scale * p.x, scale * p.y, scale * p.z);
      }
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        if (face.mIndices[i] >= mesh.mNumVertices)
          return fail(fmt::format("a face of '{}' names corner {} of {}", mesh.mName.C_Str(), face.mIndices[i],
                                  mesh.mNumVertices));
      }
      if (face.mNumIndices < 3) continue;  // points and lines have no surface
      if (soup_.corners.size() + face.mNumIndices > kLargestCorners)
        return fail(fmt::format("more than {} corners", kLargestCorners));
      soup_.faces.push_back({static_cast<std::uint32_t>(soup_.corners.size()), face.mNumIndices, mesh.mMaterialIndex});
      for (unsigned i = 0; i < face.mNumIndices; ++i) soup_.corners.push_back(first + face.mIndices[i]);
    }
    return {};
  }

  const aiScene& scene_;
  double scale_;
  bool y_up_;
  Soup& soup_;
};

}  // namespace

Result<Soup> read_mesh_file(const std::filesystem::path& path, const LoadOptions& options) {
  const auto wrong = [&](const std::string& what) { return fail(fmt::format("{}: {}", path.string(), what)); };
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error) return wrong(error.message());
  if (bytes > kLargestBytes) return wrong(fmt::format("{} bytes are more than {} MB", bytes, kLargestBytes >> 20U));
  const bool gltf = is_a(path, ".gltf") || is_a(path, ".glb");
  if (gltf) {
    const auto problem = gltf_problem(path);
    if (!problem) return tl::unexpected(problem.error());
    if (!problem->empty()) return wrong(*problem);
  }
  try {
    const MapFolder folder(path);
    Assimp::Importer importer;
    auto* const io = new MapIo(folder);
    importer.SetIOHandler(io);  // which deletes it
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (!io->refused().empty()) return wrong(io->refused());
    if (scene == nullptr || scene->mRootNode == nullptr) return wrong(importer.GetErrorString());
    Soup soup;
    for (unsigned i = 0; i < scene->mNumMaterials; ++i)
      soup.materials.push_back(material_of(*scene->mMaterials[i], gltf));
    if (!gltf) {
      const auto given = given_colors(folder);
      for (Material& material : soup.materials) {
        if (given.find(material.name) == given.end()) material.known_color = false;
        if (!material.known_color) material.color.setConstant(0.5F);
      }
    }
    const bool y_up = options.up == UpAxis::kY || (options.up == UpAxis::kByFormat && gltf);
    if (auto good = Collector(*scene, options.scale, y_up, soup).add(*scene->mRootNode, aiMatrix4x4(), 0); !good)
      return wrong(good.error().message);
    return soup;
  } catch (const std::exception& e) {
    return wrong(e.what());
  }
}

}  // namespace cgsr::world
