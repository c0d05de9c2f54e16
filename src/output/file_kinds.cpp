// The kinds of file that the program writes, each known by its first bytes.
#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "src/output/output_claims.h"

namespace cgsr::app {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kBlank = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
  return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

std::string_view first_line(std::string_view text) {
  return trimmed(text.substr(0, text.find('\n')));
}

/// Whether `text` begins with `beginning`, as columns do: a name is whole.
bool begins_with_columns(std::string_view text, std::string_view beginning) {
  return text.starts_with(beginning) && (text.size() == beginning.size() || text[beginning.size()] == ',');
}

/// The first two characters that are no blanks.
bool begins_with_tokens(std::string_view text, char first, std::string_view second) {
  text = trimmed(text);
  if (text.empty() || text.front() != first) return false;
  text = trimmed(text.substr(1));
  return !text.empty() && second.find(text.front()) != std::string_view::npos;
}

bool begins_with_any(std::string_view text, std::initializer_list<std::string_view> magics) {
  return std::ranges::any_of(magics, [text](std::string_view magic) { return text.starts_with(magic); });
}

/// RIFF, a length, and what it is.
bool is_riff(std::string_view text, std::string_view what) {
  return text.starts_with("RIFF") && text.size() >= 12 && text.substr(8, 4) == what;
}

/// Whether every section of a TOML text is one of these, and no value stands before the first.
bool has_only_sections(std::string_view text, const std::vector<std::string>& sections) {
  bool in_section = false;
  while (!text.empty()) {
    std::string_view line = first_line(text);
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
    if (line.empty() || line.front() == '#') continue;
    if (line.front() != '[') {
      if (!in_section) return false;
      continue;
    }
    line.remove_prefix(std::min(line.find_first_not_of('['), line.size()));
    line = trimmed(line.substr(0, line.find(']')));
    in_section = std::ranges::find(sections, line) != sections.end();
    if (!in_section) return false;
  }
  return in_section;
}

}  // namespace

FileKind csv_file(std::string_view header) {
  return {fmt::format("a CSV file with the columns {}{}", header.substr(0, 40), header.size() > 40 ? "..." : ""),
          [header = std::string(header)](std::string_view head) {
            const std::string_view line = first_line(head);
            return !line.empty() && (begins_with_columns(header, line) || begins_with_columns(line, header));
          }};
}

FileKind json_object() {
  return {"a JSON object", [](std::string_view head) { return begins_with_tokens(head, '{', "\"}"); }};
}

FileKind json_list() {
  return {"a JSON list of objects", [](std::string_view head) { return begins_with_tokens(head, '[', "{]"); }};
}

FileKind mcap_file() {
  return {"an MCAP recording", [](std::string_view head) { return head.starts_with("\x89MCAP"); }};
}

FileKind video_file() {
  return {"a video",
          [](std::string_view head) {
            return head.starts_with("\x1A\x45\xDF\xA3") || is_riff(head, "AVI ") ||
                   (head.size() >= 8 && head.substr(4, 4) == "ftyp");
          },
          {".avi", ".mkv", ".mp4"}};
}

FileKind picture_file() {
  return {"a picture",
          [](std::string_view head) {
            const bool pnm = head.size() > 2 && head[0] == 'P' && head[1] >= '1' && head[1] <= '6' &&
                             kBlank.find(head[2]) != std::string_view::npos;
            return pnm || is_riff(head, "WEBP") ||
                   begins_with_any(head, {"\x89PNG\r\n"sv, "\xFF\xD8\xFF"sv, "BM"sv, "II*\0"sv, "MM\0*"sv});
          },
          {".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff", ".webp", ".ppm", ".pgm"}};
}

FileKind compact_map() {
  return {"a map of cgsr map import", [](std::string_view head) { return head.starts_with("CGSRMAP"); }, {".cgsrmap"}};
}

FileKind color_model() {
  return {"a model of cgsr learn",
          [](std::string_view head) { return head.substr(0, 64).find("cgsr colour model") != std::string_view::npos; }};
}

FileKind camera_yaml() {
  return {"a camera file", [](std::string_view head) {
            return head.find("image_width:") != std::string_view::npos &&
                   head.find("camera_matrix:") != std::string_view::npos;
          }};
}

FileKind html_page() {
  return {"an HTML page", [](std::string_view head) {
            std::string beginning(trimmed(head).substr(0, 14));
            std::ranges::transform(beginning, beginning.begin(),
                                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
            return beginning.starts_with("<!doctype html") || beginning.starts_with("<html");
          }};
}

FileKind toml_with(std::vector<std::string> sections) {
  std::string name = fmt::format("a TOML file with only [{}]", fmt::join(sections, "], ["));
  return {std::move(name),
          [sections = std::move(sections)](std::string_view head) { return has_only_sections(head, sections); }};
}

FileKind same_text(std::string text) {
  return {"the same text", [text = std::move(text)](std::string_view head) { return head == text; }};
}

FileKind text_beginning(std::string text) {
  std::string name = fmt::format("a file that begins with '{}'", text);
  return {std::move(name), [text = std::move(text)](std::string_view head) { return head.starts_with(text); }};
}

}  // namespace cgsr::app
