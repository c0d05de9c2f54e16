#include "hal/sim/calibration/map_file.h"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "hal/sim/render/pattern.h"
#include "hal/sim/scene/portable_math.h"

namespace cgsr::sim {
namespace {

bool in_map(const Part& part) {
  return part.figure < 0 && part.in_map && !part.mesh.polygons.empty();
}

// Names in these files end at a space for many readers.
std::string word(const std::string& name) {
  std::string result;
  for (const char c : name) result += c > ' ' && c != '#' && c != '\\' ? c : '_';
  return result.empty() ? "_" : result;
}

// One name for each material, even where meshes from files bring the same ones along.
std::vector<std::string> material_words(const Scene& scene) {
  std::vector<std::string> words;
  std::set<std::string> taken;
  for (const Material& material : scene.materials) {
    std::string name = word(material.name);
    if (taken.count(name) != 0) name += fmt::format("_{}", words.size());
    taken.insert(name);
    words.push_back(std::move(name));
  }
  return words;
}

std::string commented(const std::string& comment) {
  std::string text;
  std::size_t at = 0;
  while (at < comment.size()) {
    const std::size_t end = std::min(comment.find('\n', at), comment.size());
    text += fmt::format("# {}\n", comment.substr(at, end - at));
    at = end + 1;
  }
  return text;
}

// The mean colour: a footprint that is much wider than the pattern.
Rgb mean_albedo(const Material& material) {
  SurfacePoint wide;
  wide.width = Eigen::Vector2f::Constant(1000.0F * std::max(material.size_m, 0.01F));
  return albedo_at(material, {}, wide);
}

std::string encoded(const Rgb& linear) {
  return fmt::format("{:.6f} {:.6f} {:.6f}", srgb_encode(static_cast<double>(linear[0])),
                     srgb_encode(static_cast<double>(linear[1])), srgb_encode(static_cast<double>(linear[2])));
}

void add_part(std::string& text, const Part& part, const std::string& material, std::size_t& corners_before) {
  text += fmt::format("o {}\nusemtl {}\n", word(part.name), material);
  std::map<std::array<float, 3>, std::size_t> index_of;
  std::string faces;
  for (const auto& outline : part.mesh.polygons) {
    faces += 'f';
    for (const std::uint32_t corner : outline) {
      const Eigen::Vector3f& p = part.mesh.position_m[corner];
      const auto [found, is_new] = index_of.try_emplace({p.x(), p.y(), p.z()}, corners_before + index_of.size() + 1);
      if (is_new) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
      faces += fmt::format(" {}", found->second);
    }
    faces += '\n';
  }
  corners_before += index_of.size();
  text += faces;
}

Result<void> write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) return fail(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
  return {};
}

}  // namespace

std::string map_as_obj(const Scene& scene, const std::string& materials_file, const std::string& comment) {
  std::string text =
      commented(comment) + "# metres, z up; a face is a surface\n" + fmt::format("mtllib {}\n", materials_file);
  const std::vector<std::string> materials = material_words(scene);
  std::size_t corners = 0;
  for (const Part& part : scene.parts) {
    if (in_map(part)) add_part(text, part, materials[static_cast<std::size_t>(part.material)], corners);
  }
  return text;
}

std::string materials_as_mtl(const Scene& scene, const std::string& comment) {
  std::set<int> used;
  for (const Part& part : scene.parts) {
    if (in_map(part)) used.insert(part.material);
  }
  std::string text = commented(comment) + "# Kd: the mean colour of the surface, sRGB\n";
  const std::vector<std::string> words = material_words(scene);
  for (const int i : used) {
    const Material& material = scene.materials[static_cast<std::size_t>(i)];
    text += fmt::format("newmtl {}\n", words[static_cast<std::size_t>(i)]);
    if (material.pattern != PatternKind::kPlain) text += fmt::format("# pattern {}\n", to_string(material.pattern));
    // What mesh_file.cpp reads back: 0.08 is the reflectance at normal incidence of Ks = 1.
    text += fmt::format("Kd {}\nKs {:.6f} {:.6f} {:.6f}\nPr {:.6f}\n", encoded(mean_albedo(material)),
                        material.specular / 0.08F, material.specular / 0.08F, material.specular / 0.08F,
                        material.roughness);
    const Rgb& glow = material.emission_cd_m2;
    if (glow.maxCoeff() > 0.0F) text += fmt::format("Ke {} {} {}\n", glow[0], glow[1], glow[2]);
  }
  return text;
}

Result<void> write_map(const Scene& scene, const std::filesystem::path& obj, const std::string& comment) {
  std::filesystem::path mtl = obj;
  mtl.replace_extension(".mtl");
  if (auto written = write(obj, map_as_obj(scene, mtl.filename().string(), comment)); !written) return written;
  return write(mtl, materials_as_mtl(scene, comment));
}

}  // namespace cgsr::sim
