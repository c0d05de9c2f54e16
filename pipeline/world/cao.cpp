#include "pipeline/world/cao.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>

#include "pipeline/geometry/pose.h"
#include "pipeline/world/file_text.h"
#include "pipeline/world/map_folder.h"

namespace cgsr::world {
namespace {

constexpr std::size_t kDeepest = 8;
constexpr std::size_t kMostFiles = 1000;

struct Word {
  std::string_view text;
  int line = 0;
};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

class Reader {
 public:
  Reader(Soup& soup, const CaoLimits& limits, const MapFolder& folder)
      : soup_(soup), limits_(limits), folder_(folder) {}

  Result<void> read(const std::filesystem::path& path, const geometry::Pose& X_WF) {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(path, error);
    if (error) return fail(fmt::format("{}: {}", path.string(), error.message()));
    if (std::find(open_.begin(), open_.end(), whole) != open_.end())
      return fail(fmt::format("{}: it loads itself, by way of {}", path.string(), open_.back().string()));
    if (open_.size() >= kDeepest || ++files_ > kMostFiles)
      return fail(fmt::format("{}: files that load files, more than {} deep or {} in all", path.string(), kDeepest,
                              kMostFiles));
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && bytes_ + size > limits_.bytes)
      return fail(fmt::format("{}: {} bytes after {} of the files before it: expected at most {} in all", path.string(),
                              size, bytes_, limits_.bytes));
    auto text = read_text(path);
    if (!text) return tl::unexpected(text.error());
    bytes_ += text->size();
    open_.push_back(whole);
    auto good = File{*this, path, X_WF, *text}.run();
    open_.pop_back();
    return good;
  }

 private:
  // One file. Lines without comments; a section's numbers may be spread over lines as they like, but options end their line.
  struct File {
    Reader& reader;
    const std::filesystem::path& path;
    const geometry::Pose& X_WF;
    std::string_view text;
    int line = 0;
    std::vector<Word> words{};  // left of the line.
    std::size_t at = 0;
    std::uint32_t first_point = 0;
    std::uint32_t points = 0;
    std::vector<std::array<std::uint32_t, 2>> lines{};
    std::vector<bool> in_face{};

    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what) const {
      return fail(fmt::format("{}:{}: {}", path.string(), line, what));
    }

    // The next line with something on it. false: the end.
    bool next_line(std::string_view& content) {
      while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        content = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++line;
        content = trimmed(content.substr(0, std::min(content.find('#'), content.find("//"))));
        if (!content.empty()) return true;
      }
      return false;
    }

    bool next_word(std::string_view& word) {
      while (at == words.size()) {
        std::string_view content;
        if (!next_line(content)) return false;
        words.clear();
        at = 0;
        while (!content.empty()) {
          std::size_t end = 0;
          while (end < content.size() && std::isspace(static_cast<unsigned char>(content[end])) == 0) ++end;
          words.push_back({content.substr(0, end), line});
          content = trimmed(content.substr(end));
        }
      }
      word = words[at++].text;
      return true;
    }

    // name=..., useLod=..., minLineLengthThreshold=... and the like, to the end of the line.
    void skip_options() {
      if (at < words.size() && words[at].text.find('=') != std::string_view::npos) at = words.size();
    }

    template <class Number>
    Result<Number> number(const char* what) {
      std::string_view word;
      if (!next_word(word)) return wrong(fmt::format("the file ends where {} should stand", what));
      const auto value = number_in<Number>(word);
      if (!value) return wrong(fmt::format("'{}' where {} should stand", word, what));
      return *value;
    }

    Result<std::uint32_t> index(const char* what, std::size_t count) {
      auto value = number<std::uint32_t>(what);
      if (value && *value >= count) return wrong(fmt::format("{} {}: there are {}", what, *value, count));
      return value;
    }

    // How many rows follow. A file may end before its last sections.
    Result<std::uint32_t> count(const char* what, std::uint32_t most) {
      std::string_view word;
      if (!next_word(word)) return 0U;
      const auto value = number_in<std::uint32_t>(word);
      if (!value) return wrong(fmt::format("'{}' where the number of {} should stand", word, what));
      if (*value > most) return wrong(fmt::format("{} {}: expected at most {}", *value, what, most));
      return *value;
    }

    // The same where the files that were read before hold some of what there may be in all.
    Result<std::uint32_t> count_with(const char* what, std::size_t before, std::size_t most) {
      auto n = count(what, std::numeric_limits<std::uint32_t>::max());
      if (n && *n > most - before)
        return wrong(before == 0 ? fmt::format("{} {}: expected at most {}", *n, what, most)
                                 : fmt::format("{} {} after {} of the files before: expected at most {} in all", *n,
                                               what, before, most));
      return n;
    }

    Result<void> run() {
      std::string_view content;
      if (!next_line(content) || content != "V1")
        return wrong(fmt::format("'{}': a .cao file begins with V1", content));
      first_point = static_cast<std::uint32_t>(reader.soup_.points.size());
      // Other files come first; their points are their own.
      for (;;) {
        const std::string_view rest = text;
        const int line_before = line;
        if (!next_line(content)) break;
        if (content.substr(0, 4) != "load") {
          text = rest;
          line = line_before;
          break;
        }
        if (auto good = include(content); !good) return good;
      }
      first_point = static_cast<std::uint32_t>(reader.soup_.points.size());
      if (auto good = read_points(); !good) return good;
      if (auto good = read_lines(); !good) return good;
      if (auto good = read_faces_of_lines(); !good) return good;
      if (auto good = read_faces_of_points(); !good) return good;
      if (auto good = read_none("cylinders"); !good) return good;
      if (auto good = read_none("circles"); !good) return good;
      std::string_view word;
      if (next_word(word)) return wrong(fmt::format("'{}': the file should have ended", word));
      for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!in_face[i]) reader.soup_.lines.push_back(lines[i]);
      }
      return {};
    }

    // load("name.cao", t=[x; y; z], tu=[x; y; z])
    Result<void> include(std::string_view content) {
      const std::size_t open = content.find('"');
      const std::size_t close = open == std::string_view::npos ? open : content.find('"', open + 1);
      if (close == std::string_view::npos || close == open + 1) return wrong("expected load(\"file.cao\")");
      const std::string_view name = content.substr(open + 1, close - open - 1);
      geometry::Pose X_FG = geometry::Pose::Identity();
      std::string_view rest = content.substr(close + 1);
      std::string packed;
      std::copy_if(rest.begin(), rest.end(), std::back_inserter(packed),
                   [](char c) { return std::isspace(static_cast<unsigned char>(c)) == 0; });
      rest = packed;
      while (!rest.empty() && rest != ")" && rest != ",)") {
        const bool moves = rest.substr(0, 4) == ",t=[";
        const bool turns = rest.substr(0, 5) == ",tu=[";
        const std::size_t end = rest.find(']');
        if ((!moves && !turns) || end == std::string_view::npos)
          return wrong(fmt::format("'{}': expected t=[x; y; z] or tu=[x; y; z]", rest));
        const std::size_t begin = moves ? 4 : 5;
        auto three = triple(rest.substr(begin, end - begin));
        if (!three) return tl::unexpected(three.error());
        if (moves) X_FG.translation() = *three;
        if (turns) X_FG.linear() = geometry::rotation_of(*three);
        rest.remove_prefix(end + 1);
      }
      const auto file = reader.folder_.find(path.parent_path() / std::filesystem::path(name));
      if (!file) return wrong(file.error().message);
      auto good = reader.read(*file, X_WF * X_FG);
      if (!good) return fail(fmt::format("{} (loaded in {}:{})", good.error().message, path.string(), line));
      return {};
    }

    Result<Eigen::Vector3d> triple(std::string_view list) const {
      Eigen::Vector3d value;
      for (int i = 0; i < 3; ++i) {
        const std::size_t end = i < 2 ? std::min(list.find(';'), list.find(',')) : list.size();
        if (end == std::string_view::npos) return wrong("expected three numbers between [ and ]");
        const auto parsed = number_in<double>(list.substr(0, end));
        if (!parsed || !std::isfinite(*parsed)) return wrong(fmt::format("'{}' is not a number", list.substr(0, end)));
        value[i] = *parsed;
        list.remove_prefix(std::min(end + 1, list.size()));
      }
      return value;
    }

    Result<void> read_points() {
      auto n = count_with("points", reader.soup_.points.size(), reader.limits_.points);
      if (!n) return tl::unexpected(n.error());
      points = *n;
      for (std::uint32_t i = 0; i < points; ++i) {
        Eigen::Vector3d p;
        for (int k = 0; k < 3; ++k) {
          auto x = number<double>("a point's coordinate");
          if (!x) return tl::unexpected(x.error());
          if (!std::isfinite(*x)) return wrong(fmt::format("{} is not a coordinate", *x));
          p[k] = *x;
        }
        skip_options();
        reader.soup_.points.emplace_back((X_WF * p).cast<float>());
      }
      return {};
    }

    Result<void> read_lines() {
      auto n = count_with("lines", reader.lines_, reader.limits_.lines);
      if (!n) return tl::unexpected(n.error());
      reader.lines_ += *n;
      for (std::uint32_t i = 0; i < *n; ++i) {
        auto a = index("point", points);
        if (!a) return tl::unexpected(a.error());
        auto b = index("point", points);
        if (!b) return tl::unexpected(b.error());
        skip_options();
        lines.push_back({first_point + *a, first_point + *b});
      }
      in_face.assign(lines.size(), false);
      return {};
    }

    Result<void> add_face(const std::vector<std::uint32_t>& outline) {
      Soup& soup = reader.soup_;
      if (soup.faces.size() >= kLargestFaces || soup.corners.size() + outline.size() > kLargestCorners)
        return wrong(fmt::format("more than {} faces or {} corners", kLargestFaces, kLargestCorners));
      soup.faces.push_back(
          {static_cast<std::uint32_t>(soup.corners.size()), static_cast<std::uint32_t>(outline.size()), 0});
      soup.corners.insert(soup.corners.end(), outline.begin(), outline.end());
      return {};
    }

    Result<void> read_faces_of_lines() {
      auto n = count("faces from lines", kLargestFaces);
      if (!n) return tl::unexpected(n.error());
      std::vector<std::uint32_t> own;
      for (std::uint32_t i = 0; i < *n; ++i) {
        auto sides = number<std::uint32_t>("the number of a face's lines");
        if (!sides) return tl::unexpected(sides.error());
        if (*sides < 3 || *sides > kLargestOutline) return wrong(fmt::format("a face of {} lines", *sides));
        own.clear();
        for (std::uint32_t k = 0; k < *sides; ++k) {
          auto which = index("line", lines.size());
          if (!which) return tl::unexpected(which.error());
          own.push_back(*which);
          in_face[*which] = true;
        }
        skip_options();
        auto outline = closed(own);
        if (!outline) return tl::unexpected(outline.error());
        if (auto good = add_face(*outline); !good) return good;
      }
      return {};
    }

    // Lines in their order, each turned as it must be, to the corners that they go round.
    Result<std::vector<std::uint32_t>> closed(const std::vector<std::uint32_t>& own) const {
      const auto& first = lines[own[0]];
      const auto& second = lines[own[1]];
      std::vector<std::uint32_t> outline;
      const bool turned = first[0] == second[0] || first[0] == second[1];
      outline.push_back(turned ? first[1] : first[0]);
      outline.push_back(turned ? first[0] : first[1]);
      for (std::size_t i = 1; i < own.size(); ++i) {
        const auto& next = lines[own[i]];
        if (next[0] == outline.back()) {
          outline.push_back(next[1]);
        } else if (next[1] == outline.back()) {
          outline.push_back(next[0]);
        } else {
          return wrong(fmt::format("a face's lines do not go round: line {} does not begin where line {} ends", own[i],
                                   own[i - 1]));
        }
      }
      if (outline.front() != outline.back()) return wrong("a face's lines do not close");
      outline.pop_back();
      return outline;
    }

    Result<void> read_faces_of_points() {
      auto n = count("faces from points", kLargestFaces);
      if (!n) return tl::unexpected(n.error());
      std::vector<std::uint32_t> outline;
      for (std::uint32_t i = 0; i < *n; ++i) {
        auto corners = number<std::uint32_t>("the number of a face's points");
        if (!corners) return tl::unexpected(corners.error());
        if (*corners < 3 || *corners > kLargestOutline) return wrong(fmt::format("a face of {} points", *corners));
        outline.clear();
        for (std::uint32_t k = 0; k < *corners; ++k) {
          auto which = index("point", points);
          if (!which) return tl::unexpected(which.error());
          outline.push_back(first_point + *which);
        }
        skip_options();
        if (auto good = add_face(outline); !good) return good;
      }
      return {};
    }

    Result<void> read_none(const char* what) {
      auto n = count(what, kLargestFaces);
      if (!n) return tl::unexpected(n.error());
      if (*n > 0)
        return wrong(fmt::format("{} {}: {} are not read; leave them out or model them by faces", *n, what, what));
      return {};
    }
  };

  Soup& soup_;
  const CaoLimits& limits_;
  MapFolder folder_;
  std::vector<std::filesystem::path> open_;
  std::size_t files_ = 0;
  std::size_t lines_ = 0;
  std::uintmax_t bytes_ = 0;
};

}  // namespace

Result<Soup> read_cao(const std::filesystem::path& path, const CaoLimits& limits) {
  Soup soup;
  soup.one_sided = true;  // as ViSP has it: whether a face is seen is told by its normal
  soup.materials.push_back({"model", Eigen::Vector3f::Constant(0.5F), false});
  if (auto good = Reader(soup, limits, MapFolder(path)).read(path, geometry::Pose::Identity()); !good)
    return tl::unexpected(good.error());
  return soup;
}

}  // namespace cgsr::world
