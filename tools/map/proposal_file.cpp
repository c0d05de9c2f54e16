#include "tools/map/proposal_file.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "pipeline/mapping/obj_words.h"

namespace cgsr::app {
namespace {

constexpr std::uintmax_t kLargest_bytes = 16U << 20U;
constexpr std::string_view kName = "proposal_";

using mapping::read_number;
using mapping::words_of;

class Reader {
 public:
  explicit Reader(std::string_view name) : name_(name) {}

  Result<void> take(std::string_view line) {
    ++line_;
    const auto words = words_of(line);
    if (words.empty() || words[0].starts_with('#')) return {};
    if (words[0] == "o") return take_name(words);
    if (words[0] == "v") return take_point(words);
    if (words[0] == "l") return take_line(words);
    return wrong(fmt::format("begins with '{}': expected o, v or l", words[0]));
  }

  Result<std::map<int, mapping::Proposal>> finish() {
    if (number_ != 0) return wrong(fmt::format("proposal {} has no line `l A B`", number_));
    return std::move(proposals_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> wrong(const std::string& message) const {
    return fail(fmt::format("{}:{}: {}", name_, line_, message));
  }

  Result<void> take_name(const std::vector<std::string_view>& words) {
    if (number_ != 0) return wrong(fmt::format("proposal {} has no line `l A B`", number_));
    const std::string_view word = words.size() > 1 ? words[1] : "";
    const std::string_view rest = word.starts_with(kName) ? word.substr(kName.size()) : "";
    int number = 0;
    if (!read_number(rest.substr(0, rest.find('_')), number) || number < 1) {
      return wrong(fmt::format("an object is '{}': expected a name as {}1_seen_in_9_images", word, kName));
    }
    if (proposals_.contains(number)) return wrong(fmt::format("proposal {} is there twice", number));
    number_ = number;
    return {};
  }

  Result<void> take_point(const std::vector<std::string_view>& words) {
    Eigen::Vector3d p;
    bool read = words.size() == 4;
    for (std::size_t i = 0; read && i < 3; ++i) {
      double& value = p[static_cast<Eigen::Index>(i)];
      read = read_number(words[i + 1], value) && std::isfinite(value);
    }
    if (!read) return wrong("an end is not three finite numbers");
    points_.push_back(p);
    return {};
  }

  Result<void> take_line(const std::vector<std::string_view>& words) {
    std::size_t a = 0;
    std::size_t b = 0;
    const bool read = words.size() == 3 && read_number(words[1], a) && read_number(words[2], b);
    if (!read || number_ == 0 || a == 0 || b == 0 || a == b || a > points_.size() || b > points_.size()) {
      return wrong(fmt::format("a line is not between two of the {} ends before it", points_.size()));
    }
    mapping::Proposal& proposal = proposals_[number_];
    proposal.a = points_[a - 1];
    proposal.b = points_[b - 1];
    number_ = 0;
    return {};
  }

  std::string_view name_;
  int line_ = 0;
  int number_ = 0;  // of the proposal that is being read; 0: none
  std::vector<Eigen::Vector3d> points_;
  std::map<int, mapping::Proposal> proposals_;
};

}  // namespace

std::string proposals_as_obj(std::span<const mapping::Proposal> proposals) {
  std::string text = fmt::format("{}\n", kProposalsTitle);
  int count = 0;
  for (const mapping::Proposal& line : proposals) {
    const std::string of = line.part.empty() ? "" : fmt::format("_of_{}_moved", line.part);
    text += fmt::format("o {}{}{}_seen_in_{}_images\n", kName, count / 2 + 1, of, line.images);
    for (const Eigen::Vector3d& p : {line.a, line.b})
      text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", p.x(), p.y(), p.z());
    text += fmt::format("l {} {}\n", count + 1, count + 2);
    count += 2;
  }
  return text;
}

Result<std::map<int, mapping::Proposal>> parse_proposals(std::string_view text, std::string_view name) {
  if (!text.starts_with(kProposalsTitle)) {
    return fail(fmt::format("{}: is no file of proposals: expected one that cgsr map refine --proposals wrote", name));
  }
  Reader reader(name);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (auto taken = reader.take(text.substr(0, end)); !taken) return tl::unexpected(taken.error());
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return reader.finish();
}

Result<std::map<int, mapping::Proposal>> read_proposals(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return fail(fmt::format("{}: cannot be read: {}", file.string(), error.message()));
  if (size > kLargest_bytes) {
    return fail(fmt::format("{}: has {} bytes: expected at most {}", file.string(), size, kLargest_bytes));
  }
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  if (size > 0) text << stream.rdbuf();
  if (!stream) return fail(fmt::format("{}: cannot be read", file.string()));
  return parse_proposals(text.str(), file.string());
}

}  // namespace cgsr::app
