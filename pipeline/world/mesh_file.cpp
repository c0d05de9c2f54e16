#include "pipeline/world/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <exception>
#include <string>
#include <system_error>
#include <vector>

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

#include "pipeline/world/file_text.h"

namespace cgsr::world {
namespace {

constexpr int kDeepest = 256;

float encoded(float linear) {
  const float x = std::clamp(linear, 0.0F, 1.0F);
  return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1.0F / 2.4F) - 0.055F;
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
  const bool gltf = path.extension() == ".gltf" || path.extension() == ".glb";
  try {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (scene == nullptr || scene->mRootNode == nullptr) return wrong(importer.GetErrorString());
    Soup soup;
    for (unsigned i = 0; i < scene->mNumMaterials; ++i)
      soup.materials.push_back(material_of(*scene->mMaterials[i], gltf));
    const bool y_up = options.up == UpAxis::kY || (options.up == UpAxis::kByFormat && gltf);
    if (auto good = Collector(*scene, options.scale, y_up, soup).add(*scene->mRootNode, aiMatrix4x4(), 0); !good)
      return wrong(good.error().message);
    return soup;
  } catch (const std::exception& e) {
    return wrong(e.what());
  }
}

}  // namespace cgsr::world
