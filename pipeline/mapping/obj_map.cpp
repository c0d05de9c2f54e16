#include "pipeline/mapping/obj_map.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "pipeline/mapping/obj_words.h"

namespace cgsr::mapping {
namespace {

constexpr std::uintmax_t kLargest_bytes = 256U << 20U;

class Reader {
 public:
  explicit Reader(std::string_view name) : name_(name) {}

  Result<void> take(std::string_view line) {
    map_.lines.emplace_back(line);
    const auto words = words_of(line);
    if (words.empty()) return {};
    if (words[0] == "v") return take_point(words);
    if (words[0] == "f") return take_face(words);
    if (words[0] == "o" || words[0] == "g") map_.parts.emplace_back(words.size() > 1 ? words[1] : "map");
    return {};
  }

  Result<ObjMap> finish() {
    if (map_.faces.empty()) return fail(fmt::format("{}: holds no face: expected lines `f A B C ...`", name_));
    return std::move(map_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> wrong(const std::string& message) const {
    return fail(fmt::format("{}:{}: {}", name_, map_.lines.size(), message));
  }

  Result<void> take_point(const std::vector<std::string_view>& words) {
    if (words.size() < 4) return wrong(fmt::format("has {} coordinates: expected three", words.size() - 1));
    Eigen::Vector3d p;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!read_number(words[i + 1], p[static_cast<Eigen::Index>(i)]) ||
          !std::isfinite(p[static_cast<Eigen::Index>(i)])) {
        return wrong(fmt::format("a coordinate is '{}': expected a finite number", words[i + 1]));
      }
    }
    map_.points.push_back(p);
    map_.point_line.push_back(map_.lines.size() - 1);
    return {};
  }

  Result<void> take_face(const std::vector<std::string_view>& words) {
    if (words.size() < 4) return wrong(fmt::format("has {} corners: expected three or more", words.size() - 1));
    if (map_.parts.empty()) map_.parts.emplace_back("map");
    ObjMap::Face face;
    face.part = static_cast<std::uint32_t>(map_.parts.size() - 1);
    const auto count = static_cast<std::int64_t>(map_.points.size());
    for (std::size_t i = 1; i < words.size(); ++i) {
      std::int64_t number = 0;
      const bool read = read_number(words[i].substr(0, words[i].find('/')), number);
      const std::int64_t index = number < 0 ? count + number : number - 1;
      if (!read || number == 0 || index < 0 || index >= count) {
        return wrong(fmt::format("a corner is '{}': expected one of the {} before this line", words[i], count));
      }
      face.corners.push_back(static_cast<std::uint32_t>(index));
    }
    map_.faces.push_back(std::move(face));
    return {};
  }

  std::string_view name_;
  ObjMap map_;
};

}  // namespace

Result<ObjMap> parse_obj(std::string_view text, std::string_view name) {
  Reader reader(name);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (auto taken = reader.take(text.substr(0, end)); !taken) return tl::unexpected(taken.error());
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.finish();
}

Result<ObjMap> read_obj(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return fail(fmt::format("{}: cannot be read: {}", file.string(), error.message()));
  if (size > kLargest_bytes) {
    return fail(fmt::format("{}: has {} bytes: expected at most {}", file.string(), size, kLargest_bytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream) return fail(fmt::format("{}: cannot be read", file.string()));
  return parse_obj(text.str(), file.string());
}

std::string obj_text(const ObjMap& map, const std::vector<Eigen::Vector3d>& points,
                     const std::filesystem::path& folder_of_materials) {
  std::string text;
  std::size_t point = 0;
  for (std::size_t i = 0; i < map.lines.size(); ++i) {
    const std::string& line = map.lines[i];
    if (point < points.size() && map.point_line[point] == i) {
      const Eigen::Vector3d& p = points[point];
      text += p == map.points[point] ? line : fmt::format("v {:.5f} {:.5f} {:.5f}", p.x(), p.y(), p.z());
      ++point;
    } else if (const auto words = words_of(line);
               !folder_of_materials.empty() && words.size() > 1 && words[0] == "mtllib") {
      text += fmt::format("mtllib {}", (folder_of_materials / words[1]).generic_string());
    } else {
      text += line;
    }
    text += '\n';
  }
  return text;
}

}  // namespace cgsr::mapping
