#include "tools/lab/sources.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "platform/config/sha256.h"
#include "tools/lab/child.h"

namespace cgsr::lab {
namespace {

namespace fs = std::filesystem;

bool is_source(const fs::path& file) {
  const auto ending = file.extension();
  return ending == ".h" || ending == ".cpp" || ending == ".toml";
}

/// \return the end of the literal that begins at `at`: behind its closing quote.
std::size_t end_of_literal(std::string_view text, std::size_t at) {
  const char quote = text[at];
  for (std::size_t i = at + 1; i < text.size(); ++i) {
    if (text[i] == '\\') {
      ++i;
    } else if (text[i] == quote || text[i] == '\n') {
      return i + 1;
    }
  }
  return text.size();
}

/// A ' between digits separates them and begins no literal.
bool begins_literal(std::string_view text, std::size_t at) {
  if (text[at] == '"') return true;
  return text[at] == '\'' && (at == 0 || std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0);
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::string without_comments(std::string_view cpp) {
  std::string out;
  const auto add_blank = [&out] {
    if (!out.empty() && out.back() != ' ') out += ' ';
  };
  for (std::size_t i = 0; i < cpp.size();) {
    if (cpp.substr(i, 2) == "//") {
      i = std::min(cpp.size(), cpp.find('\n', i));
    } else if (cpp.substr(i, 2) == "/*") {
      const auto end = cpp.find("*/", i + 2);
      i = end == std::string_view::npos ? cpp.size() : end + 2;
      add_blank();
    } else if (begins_literal(cpp, i)) {
      const std::size_t end = end_of_literal(cpp, i);
      out += cpp.substr(i, end - i);
      i = end;
    } else if (std::isspace(static_cast<unsigned char>(cpp[i])) != 0) {
      add_blank();
      ++i;
    } else {
      out += cpp[i++];
    }
  }
  return out;
}

Result<std::string> sources_sha256(const fs::path& root, std::span<const std::string_view> paths) {
  std::set<fs::path> files;
  for (const std::string_view path : paths) {
    const fs::path at = root / path;
    if (fs::is_regular_file(at)) {
      files.insert(path);
    } else if (fs::is_directory(at)) {
      for (const auto& entry : fs::recursive_directory_iterator(at)) {
        if (entry.is_regular_file() && is_source(entry.path())) files.insert(fs::relative(entry.path(), root));
      }
    } else {
      return fail(fmt::format("{}: is neither a file nor a folder; a table says that it measures it", at.string()));
    }
  }
  config::Sha256 sum;
  for (const fs::path& file : files) {
    const std::string name = file.generic_string();
    const std::string text = text_of(root / file);
    const std::string content = file.extension() == ".toml" ? text : without_comments(text);
    sum.add(name.data(), name.size() + 1);
    sum.add(content.data(), content.size());
  }
  return sum.hex();
}

std::string commit_of(const fs::path& root, std::span<const std::string_view> paths) {
  const auto head = run_for_text({"git", "-C", root.string(), "rev-parse", "--short=12", "HEAD"});
  if (!head) return "unknown";
  std::vector<std::string> status{"git", "-C", root.string(), "status", "--porcelain", "--"};
  status.insert(status.end(), paths.begin(), paths.end());
  const auto changed = run_for_text(status);
  const std::string commit = head->substr(0, head->find('\n'));
  return changed && !changed->empty() ? commit + "+changes" : commit;
}

}  // namespace cgsr::lab
