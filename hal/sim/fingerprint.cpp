#include "hal/sim/fingerprint.h"

#include <link.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace cgsr::sim {
namespace {

// Each struct below is hashed member by member. One that grew has a member that this file does not know yet, and images of two different
// scenes could be taken for the same: add it here, then change the number.
static_assert(sizeof(CameraModel) == 88);
static_assert(sizeof(SensorSettings) == 48);
static_assert(sizeof(Material) == 96);
static_assert(sizeof(Mesh) == 128);
static_assert(sizeof(Part) == 192);
static_assert(sizeof(LampState) == 40);
static_assert(sizeof(PresenceKey) == 16);

void add(Fingerprint& sum, const Material& material) {
  sum.matrix(material.albedo);
  sum.matrix(material.second_albedo);
  sum.number(material.pattern);
  sum.number(material.size_m);
  sum.number(material.width);
  sum.number(material.roughness);
  sum.number(material.specular);
  sum.matrix(material.emission_cd_m2);
  sum.number(material.texture);
}

void add(Fingerprint& sum, const Mesh& mesh) {
  sum.number(mesh.position_m.size());
  for (const Eigen::Vector3f& p : mesh.position_m) sum.matrix(p);
  for (const Eigen::Vector3f& n : mesh.normal) sum.matrix(n);
  for (const Eigen::Vector2f& uv : mesh.uv) sum.matrix(uv);
  sum.number(mesh.triangles.size());
  for (const Mesh::Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle.corner) sum.number(corner);
    sum.number(triangle.polygon);
  }
  sum.number(mesh.polygons.size());
  for (const auto& outline : mesh.polygons) sum.numbers(outline);
  sum.number(mesh.smooth);
}

void add(Fingerprint& sum, const Part& part) {
  add(sum, part.mesh);
  sum.number(part.material);
  sum.number(part.figure);
  sum.number(part.joint);
  sum.number(part.outfit);
  sum.number(part.casts_shadow);
  sum.number(part.lamp);
  sum.number(part.in_map);
}

// The build identity in a loaded object's notes, or what else tells its versions apart.
std::string identity_of(const dl_phdr_info& object) {
  constexpr char kOwner[] = "GNU";  // with its zero
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const auto& header = object.dlpi_phdr[i];
    if (header.p_type != PT_NOTE) continue;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): addresses are numbers here, the linker gives nothing else
    const auto* at = reinterpret_cast<const char*>(object.dlpi_addr + header.p_vaddr);
    const char* end = at + header.p_memsz;
    while (at + sizeof(ElfW(Nhdr)) <= end) {
      ElfW(Nhdr) note;
      std::memcpy(&note, at, sizeof note);
      const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
      const char* name = at + sizeof note;
      const char* content = name + padded(note.n_namesz);
      if (note.n_type == NT_GNU_BUILD_ID &&
          std::string_view(name, note.n_namesz) == std::string_view(kOwner, sizeof kOwner)) {
        return {content, note.n_descsz};
      }
      at = content + padded(note.n_descsz);
    }
  }
  const std::string file = object.dlpi_name == nullptr || *object.dlpi_name == 0 ? "/proc/self/exe" : object.dlpi_name;
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  const auto changed = std::filesystem::last_write_time(file, error).time_since_epoch().count();
  return file + std::to_string(bytes) + std::to_string(changed);
}

bool holds(const dl_phdr_info& object, std::uintptr_t address) {
  for (int i = 0; i < object.dlpi_phnum; ++i) {
    const auto& header = object.dlpi_phdr[i];
    const std::uintptr_t begin = object.dlpi_addr + header.p_vaddr;
    if (header.p_type == PT_LOAD && address >= begin && address - begin < header.p_memsz) return true;
  }
  return false;
}

// The program that loaded the simulator as a plug-in draws nothing, nor does what the kernel or valgrind adds to a process.
bool may_draw(const dl_phdr_info& object) {
  const std::string_view name = object.dlpi_name == nullptr ? "" : object.dlpi_name;
  if (name.empty()) return holds(object, reinterpret_cast<std::uintptr_t>(&program_fingerprint));
  return name.find("linux-vdso") == std::string_view::npos && name.find("vgpreload_") == std::string_view::npos;
}

}  // namespace

void Fingerprint::text(std::string_view text) {
  number(text.size());
  sum_.add(text.data(), text.size());
}

std::string fingerprint(const Scene& scene) {
  Fingerprint sum;
  sum.number(scene.materials.size());
  for (const Material& material : scene.materials) add(sum, material);
  sum.number(scene.textures.size());
  for (const Texture& texture : scene.textures) {
    sum.number(texture.levels.size());
    for (const Texture::Level& level : texture.levels) {
      sum.number(level.width_px);
      sum.number(level.height_px);
      sum.numbers(level.rgb);
    }
  }
  sum.number(scene.parts.size());
  for (const Part& part : scene.parts) add(sum, part);
  sum.number(scene.lamps.size());
  for (const Lamp& lamp : scene.lamps) sum.number(lamp.radius_m);
  sum.number(scene.ambient.from_below);
  sum.number(scene.ambient.corner_reach_m);
  return sum.hex();
}

void add(Fingerprint& sum, const CameraModel& camera) {
  sum.number(camera.width_px);
  sum.number(camera.height_px);
  for (const double value : {camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.k1, camera.k2, camera.p1,
                             camera.p2, camera.k3, camera.rate_hz}) {
    sum.number(value);
  }
}

void add(Fingerprint& sum, const SensorSettings& settings) {
  sum.number(settings.exposure_s);
  sum.number(settings.gain);
  sum.matrix(settings.white_balance);
  sum.number(settings.noise);
  sum.number(settings.full_well_e);
  sum.number(settings.read_noise_e);
}

void add(Fingerprint& sum, const Moment& moment) {
  sum.number(moment.state.time_s);
  sum.number(moment.state.X_WJ.size());
  for (const std::vector<Pose>& joints : moment.state.X_WJ) {
    sum.number(joints.size());
    for (const Pose& X : joints) sum.matrix(X.matrix());
  }
  for (const PresenceKey& presence : moment.state.presence) {
    sum.number(presence.present);
    sum.number(presence.outfit);
  }
  for (const LampState& lamp : moment.state.lamps) {
    sum.matrix(lamp.p_WL);
    sum.matrix(lamp.intensity_cd);
  }
  sum.matrix(moment.state.ambient_lux);
  sum.matrix(moment.X_WC.matrix());
}

std::string program_fingerprint() {
  std::vector<std::string> identities;
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* into) {
        if (may_draw(*object)) static_cast<std::vector<std::string>*>(into)->push_back(identity_of(*object));
        return 0;
      },
      &identities);
  std::sort(identities.begin(), identities.end());
  Fingerprint sum;
  for (const std::string& identity : identities) sum.text(identity);
  return sum.hex();
}

}  // namespace cgsr::sim
