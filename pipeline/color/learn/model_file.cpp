#include "pipeline/color/learn/model_file.h"

#include <openssl/sha.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/cbor_depth.h"
#include "platform/replace_file.h"

namespace cgsr::color {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kFormat = "cgsr colour model";
constexpr std::size_t kLargestFile =
    16U << 20;  // 125 lights of 16^3 bins with surroundings are 2 MB, 16 patches 0.6 MB

Bytes sha256_of(const Bytes& bytes) {
  Bytes digest(SHA256_DIGEST_LENGTH);
  SHA256(bytes.data(), bytes.size(), digest.data());
  return digest;
}

json box_to(const Box& box) {
  return {box.x, box.y, box.width, box.height};
}

Box box_from(const json& j) {
  const auto v = j.get<std::array<double, 4>>();
  return {v[0], v[1], v[2], v[3]};
}

json light_to(const Light& light) {
  return {light.r, light.g, light.b};
}

Light light_from(const json& j) {
  const auto v = j.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

// Rows of counts are mostly zeros: [gap, count, gap, count, …], the gap being the zeros before a count.
json counts_to(const std::vector<std::uint16_t>& counts) {
  json out = json::array();
  int gap = 0;
  for (const int count : counts) {
    if (count == 0) {
      ++gap;
      continue;
    }
    out.push_back(gap);
    out.push_back(count);
    gap = 0;
  }
  return out;
}

// \throws std::out_of_range where a count lies outside the rows.
std::vector<std::uint16_t> counts_from(const json& j, std::size_t size) {
  const auto pairs = j.get<std::vector<std::uint32_t>>();
  std::vector<std::uint16_t> counts(pairs.empty() ? 0 : size, 0);
  std::size_t at = 0;
  for (std::size_t i = 0; i + 1 < pairs.size(); i += 2, ++at) {
    at += pairs[i];
    if (pairs[i + 1] > kHistogramMass) throw std::out_of_range("a count is too large");
    counts.at(at) = static_cast<std::uint16_t>(pairs[i + 1]);
  }
  return counts;
}

json patch_to(const SamplePatch& p) {
  return {{"width_px", p.width_px},     {"height_px", p.height_px},        {"yuyv", json::binary(p.yuyv)},
          {"window", box_to(p.window)}, {"scale", {p.scale_x, p.scale_y}}, {"light", light_to(p.light)}};
}

SamplePatch patch_from(const json& j) {
  SamplePatch p;
  j.at("width_px").get_to(p.width_px);
  j.at("height_px").get_to(p.height_px);
  p.yuyv = j.at("yuyv").get_binary();
  p.window = box_from(j.at("window"));
  p.scale_x = j.at("scale").at(0).get<double>();
  p.scale_y = j.at("scale").at(1).get<double>();
  p.light = light_from(j.at("light"));
  return p;
}

json model_to(const ColorModel& m) {
  json lights = json::array(), samples = json::array();
  for (const auto& light : m.lights) lights.push_back(light_to(light));
  for (const auto& patch : m.samples) samples.push_back(patch_to(patch));
  return {{"space", static_cast<int>(m.bins.space)},
          {"bins_per_channel", m.bins.per_channel},
          {"lights", lights},
          {"object", counts_to(m.object)},
          {"surroundings", counts_to(m.surroundings)},
          {"width_px", m.width_px},
          {"height_px", m.height_px},
          {"object_box", box_to(m.object_box)},
          {"image_width_px", m.image_width_px},
          {"image_height_px", m.image_height_px},
          {"distinctiveness", m.distinctiveness},
          {"samples", samples}};
}

ColorModel model_from(const json& j) {
  ColorModel m;
  const int space = j.at("space").get<int>();
  if (space < 0 || space > static_cast<int>(imaging::ColorSpace::kYuv))
    throw std::out_of_range("an unknown colour space");
  m.bins = {static_cast<imaging::ColorSpace>(space), j.at("bins_per_channel").get<int>()};
  if (m.bins.per_channel < 2 || m.bins.per_channel > 16) throw std::out_of_range("bins per channel outside 2..16");
  for (const auto& light : j.at("lights")) m.lights.push_back(light_from(light));
  if (m.lights.size() > kMaxLights) throw std::out_of_range("too many lights");
  const auto size = m.lights.size() * static_cast<std::size_t>(m.bins.count());
  m.object = counts_from(j.at("object"), size);
  m.surroundings = counts_from(j.at("surroundings"), size);
  j.at("width_px").get_to(m.width_px);
  j.at("height_px").get_to(m.height_px);
  m.object_box = box_from(j.at("object_box"));
  j.at("image_width_px").get_to(m.image_width_px);
  j.at("image_height_px").get_to(m.image_height_px);
  j.at("distinctiveness").get_to(m.distinctiveness);
  for (const auto& patch : j.at("samples")) m.samples.push_back(patch_from(patch));
  return m;
}

Result<Bytes> read_whole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  Bytes bytes(kLargestFile + 1);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (file.bad()) return fail(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (bytes.empty()) return fail(fmt::format("{}: is empty (or a folder), not a colour model", path));
  if (bytes.size() > kLargestFile)
    return fail(fmt::format("{}: is larger than any colour model ({} MB)", path, kLargestFile >> 20));
  return bytes;
}

}  // namespace

Result<void> save_model(const ColorModel& model, const std::string& path) {
  if (auto defect = defect_of(model); !defect.empty())
    return fail(fmt::format("{}: the model is not saved, it has {}", path, defect));
  const Bytes payload = json::to_cbor(model_to(model));
  const json envelope = {{"format", kFormat},
                         {"version", kModelVersion},
                         {"sha256", json::binary(sha256_of(payload))},
                         {"payload", json::binary(payload)}};
  const Bytes bytes = json::to_cbor(envelope);

  return replace_file(path, {std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size())});
}

Result<ColorModel> load_model(const std::string& path) {
  const auto bytes = read_whole(path);
  if (!bytes) return tl::unexpected(bytes.error());
  if (const auto problem = cbor_depth_problem(*bytes))
    return fail(fmt::format("{}: not a colour model: {}", path, *problem));
  const json envelope = json::from_cbor(*bytes, true, false);
  if (envelope.is_discarded()) return fail(fmt::format("{}: not a colour model, or cut short", path));
  try {
    if (!envelope.is_object() || envelope.value("format", "") != kFormat)
      return fail(fmt::format("{}: not a colour model", path));
    const int version = envelope.at("version").get<int>();
    if (version < 1 || version > kModelVersion) {
      return fail(
          fmt::format("{}: a colour model of version {}, this program reads up to {}", path, version, kModelVersion));
    }
    const Bytes payload = envelope.at("payload").get_binary();
    if (sha256_of(payload) != Bytes(envelope.at("sha256").get_binary())) {
      return fail(fmt::format("{}: the colour model is damaged (checksum)", path));
    }
    if (const auto problem = cbor_depth_problem(payload)) {
      return fail(fmt::format("{}: the colour model is damaged: payload, {}", path, *problem));
    }
    ColorModel model = model_from(json::from_cbor(payload));
    if (auto defect = defect_of(model); !defect.empty())
      return fail(fmt::format("{}: the colour model has {}", path, defect));
    return model;
  } catch (const std::exception& wrong) {  // the library's errors end here
    return fail(fmt::format("{}: the colour model is damaged: {}", path, wrong.what()));
  }
}

}  // namespace cgsr::color
