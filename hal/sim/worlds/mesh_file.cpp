#include "hal/sim/worlds/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <system_error>

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/Importer.hpp>

namespace cgsr::sim {
namespace {

constexpr std::uintmax_t kLargestBytes = 64U << 20;

bool is_gltf(const std::filesystem::path& file) {
  return file.extension() == ".gltf" || file.extension() == ".glb";
}

Material material_of(const aiMaterial& from, bool gltf) {
  Material material;
  aiString name;
  if (from.Get(AI_MATKEY_NAME, name) == AI_SUCCESS) material.name = name.C_Str();
  aiColor3D color(0.7F, 0.7F, 0.7F);
  aiColor4D base;
  if (gltf && from.Get(AI_MATKEY_BASE_COLOR, base) == AI_SUCCESS) {
    material.albedo = Rgb(base.r, base.g, base.b);
  } else {
    from.Get(AI_MATKEY_COLOR_DIFFUSE, color);
    material.albedo = from_srgb({color.r, color.g, color.b});
  }
  float roughness = 1.0F;
  float shininess = 0.0F;
  if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness) == AI_SUCCESS) {
    material.roughness = roughness;
  } else if (from.Get(AI_MATKEY_SHININESS, shininess) == AI_SUCCESS && shininess > 0.0F) {
    material.roughness = std::sqrt(std::sqrt(2.0F / (shininess + 2.0F)));  // Blinn's exponent as GGX roughness
  }
  aiColor3D specular(0, 0, 0);
  from.Get(AI_MATKEY_COLOR_SPECULAR, specular);
  material.roughness = std::min(1.0F, std::max(0.05F, material.roughness));
  material.specular = gltf ? 0.04F : std::min(1.0F, 0.08F * std::max({specular.r, specular.g, specular.b}));
  if (material.roughness >= 1.0F) material.specular = 0.0F;
  return material;
}

// The file's coordinates to ours: scaled, and turned from y-up to z-up for glTF.
Eigen::Vector3f to_ours(const aiVector3D& v, double scale, bool y_up) {
  const auto s = static_cast<float>(scale);
  return y_up ? Eigen::Vector3f(s * v.x, -s * v.z, s * v.y) : Eigen::Vector3f(s * v.x, s * v.y, s * v.z);
}

Result<Mesh> mesh_of(const aiMesh& from, const aiMatrix4x4& X, double scale, bool y_up) {
  Mesh mesh;
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    if (face.mNumIndices < 3) continue;  // points and lines have no surface
    std::vector<Eigen::Vector3f> corners;
    std::vector<Eigen::Vector2f> uv;
    for (unsigned i = 0; i < face.mNumIndices; ++i) {
      const Eigen::Vector3f p = to_ours(X * from.mVertices[face.mIndices[i]], scale, y_up);
      if (!p.allFinite()) return fail(fmt::format("'{}' has a corner that is not finite", from.mName.C_Str()));
      corners.push_back(p);
      uv.emplace_back(p.x() + p.z(), p.y() + p.z());
    }
    const Eigen::Vector3f area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (area.squaredNorm() > 0.0F) mesh.add_polygon(corners, uv);
  }
  return mesh;
}

Result<void> collect(const aiScene& scene, const aiNode& node, const aiMatrix4x4& X_parent, double scale, bool gltf,
                     std::vector<FilePiece>& pieces) {
  const aiMatrix4x4 X = X_parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& from = *scene.mMeshes[node.mMeshes[i]];
    auto mesh = mesh_of(from, X, scale, gltf);
    if (!mesh) return tl::unexpected(mesh.error());
    if (mesh->triangles.empty()) continue;
    pieces.push_back({node.mName.C_Str(), std::move(*mesh), material_of(*scene.mMaterials[from.mMaterialIndex], gltf)});
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    if (auto good = collect(scene, *node.mChildren[i], X, scale, gltf, pieces); !good) return good;
  }
  return {};
}

}  // namespace

Result<std::vector<FilePiece>> read_mesh_file(const std::filesystem::path& file, double scale) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (error) return fail(fmt::format("{}: {}", file.string(), error.message()));
  if (bytes > kLargestBytes) return fail(fmt::format("{}: {} bytes are more than 64 MB", file.string(), bytes));
  try {
    Assimp::Importer importer;
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(file.string(), aiProcess_SortByPType);
    if (scene == nullptr || scene->mRootNode == nullptr) {
      return fail(fmt::format("{}: {}", file.string(), importer.GetErrorString()));
    }
    std::vector<FilePiece> pieces;
    if (auto good = collect(*scene, *scene->mRootNode, aiMatrix4x4(), scale, is_gltf(file), pieces); !good) {
      return fail(fmt::format("{}: {}", file.string(), good.error().message));
    }
    if (pieces.empty()) return fail(fmt::format("{}: there is no surface in it", file.string()));
    return pieces;
  } catch (const std::exception& e) {
    return fail(fmt::format("{}: {}", file.string(), e.what()));
  }
}

}  // namespace cgsr::sim
