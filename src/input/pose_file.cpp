#include "src/input/pose_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <fmt/format.h>

#include "src/input/small_file.h"

namespace cgsr::app {
namespace {

constexpr std::size_t kLargest_bytes = 64U << 20U;  // a pose for every image of hours
constexpr double kFarthest_m = 1e5;
constexpr double kWidestSigma = 180.0;   // metres or degrees
constexpr double kUnitTolerance = 1e-3;  // of a quaternion's length: four digits after the point leave less
constexpr std::array<std::string_view, 7> kNames{"tx", "ty", "tz", "qw", "qx", "qy", "qz"};

std::string_view trimmed(std::string_view text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

template <class Number>
bool read_number(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty();
}

/// Which cell of a row holds what.
struct Header {
  std::size_t cells = 0;
  std::optional<std::size_t> frame;
  std::optional<std::size_t> corrected;
  std::array<std::size_t, kNames.size()> at{};
  std::optional<std::size_t> sigma_m;
  std::optional<std::size_t> sigma_deg;
};

class PoseReader {
 public:
  explicit PoseReader(std::string_view name) : name_(name) {}

  Result<void> take(std::string_view line) {
    ++line_;
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') return {};
    return header_ ? take_row(text) : take_header(text);
  }

  Result<std::vector<PoseRow>> finish() {
    if (!header_) return fail(fmt::format("{}: is empty: expected the header [frame,]{}", name_, kPoseColumns));
    if (rows_.empty()) return fail(fmt::format("{}: holds no pose: expected a row below its header", name_));
    return std::move(rows_);
  }

 private:
  [[nodiscard]] tl::unexpected<Error> wrong(const std::string& words) const {
    return fail(fmt::format("{}:{}: {}", name_, line_, words));
  }

  Result<void> take_header(std::string_view text) {
    const auto names = cells_of(text);
    Header header;
    header.cells = names.size();
    const auto place_of = [&](std::string_view wanted) -> std::optional<std::size_t> {
      const auto found = std::ranges::find(names, wanted);
      if (found == names.end()) return std::nullopt;
      return static_cast<std::size_t>(found - names.begin());
    };
    for (std::size_t i = 0; i < kNames.size(); ++i) {
      const auto place = place_of(kNames[i]);
      if (!place) {
        return wrong(fmt::format("the header '{}' has no column '{}': expected [frame,]{}", text.substr(0, 80),
                                 kNames[i], kPoseColumns));
      }
      if (std::ranges::count(names, kNames[i]) > 1) return wrong(fmt::format("column '{}' is there twice", kNames[i]));
      header.at[i] = *place;
    }
    header.frame = place_of("frame");
    header.corrected = place_of("corrected");
    header.sigma_m = place_of("sigma_m");
    header.sigma_deg = place_of("sigma_deg");
    header_ = header;
    return {};
  }

  Result<void> take_row(std::string_view text) {
    const auto cells = cells_of(text);
    if (cells.size() != header_->cells) {
      return wrong(fmt::format("has {} values: expected {}, as the header has", cells.size(), header_->cells));
    }
    PoseRow row;
    row.line = line_;
    if (header_->frame) {
      std::int64_t frame = 0;
      const std::string_view cell = cells[*header_->frame];
      if (!read_number(cell, frame) || frame < 0) {
        return wrong(fmt::format("frame is '{}': expected the number of an image, 0 or more", cell));
      }
      if (!rows_.empty() && frame <= *rows_.back().frame) {
        return wrong(
            fmt::format("frame is {} after {}: expected rising numbers, each once", frame, *rows_.back().frame));
      }
      row.frame = frame;
    }
    if (header_->corrected && !cells[*header_->corrected].empty()) {
      const std::string_view cell = cells[*header_->corrected];
      if (cell != "0" && cell != "1") {
        return wrong(fmt::format("corrected is '{}': expected 1 for a measured pose, 0 for a predicted one", cell));
      }
      row.corrected = cell == "1";
    }
    std::array<double, kNames.size()> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const std::string_view cell = cells[header_->at[i]];
      if (!read_number(cell, v[i]) || !std::isfinite(v[i])) {
        return wrong(fmt::format("{} is '{}': expected a finite number", kNames[i], cell));
      }
      if (i < 3 && std::abs(v[i]) > kFarthest_m) {
        return wrong(fmt::format("{} is {} m: expected at most {} m either way", kNames[i], v[i], kFarthest_m));
      }
    }
    const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
    if (!(std::abs(q.norm() - 1.0) <= kUnitTolerance)) {
      return wrong(fmt::format("the quaternion ({}, {}, {}, {}) has the length {:.6g}: expected 1", v[3], v[4], v[5],
                               v[6], q.norm()));
    }
    row.X.linear() = q.normalized().toRotationMatrix();
    row.X.translation() = Eigen::Vector3d(v[0], v[1], v[2]);
    if (auto taken = take_sigma(cells, header_->sigma_m, "sigma_m", row.sigma_m); !taken) return taken;
    if (auto taken = take_sigma(cells, header_->sigma_deg, "sigma_deg", row.sigma_rad); !taken) return taken;
    if (row.sigma_rad) *row.sigma_rad *= std::numbers::pi / 180.0;
    rows_.push_back(row);
    return {};
  }

  /// An empty cell says nothing.
  [[nodiscard]] Result<void> take_sigma(const std::vector<std::string_view>& cells, std::optional<std::size_t> place,
                                        std::string_view name, std::optional<double>& sigma) const {
    if (!place || cells[*place].empty()) return {};
    double value = 0.0;
    if (!read_number(cells[*place], value) || !(value >= 0.0 && value <= kWidestSigma)) {
      return wrong(fmt::format("{} is '{}': expected a number from 0 to {}", name, cells[*place], kWidestSigma));
    }
    sigma = value;
    return {};
  }

  std::string_view name_;
  int line_ = 0;
  std::optional<Header> header_;
  std::vector<PoseRow> rows_;
};

}  // namespace

Result<std::vector<PoseRow>> parse_poses(const std::string& text, std::string_view name) {
  PoseReader reader(name);
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    if (auto taken = reader.take(rest.substr(0, end)); !taken) return tl::unexpected(taken.error());
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return reader.finish();
}

Result<std::vector<PoseRow>> read_poses(const std::filesystem::path& file) {
  const auto text = read_small_file(file, kLargest_bytes, "a file of poses");
  if (!text) return tl::unexpected(text.error());
  return parse_poses(*text, file.string());
}

Result<geometry::Pose> read_pose(const std::filesystem::path& file) {
  const auto rows = read_poses(file);
  if (!rows) return tl::unexpected(rows.error());
  if (rows->size() > 1) {
    return fail(fmt::format("{}:{}: holds {} poses: expected one", file.string(), (*rows)[1].line, rows->size()));
  }
  return rows->front().X;
}

std::string pose_as_csv(const geometry::Pose& X) {
  Eigen::Quaterniond q(X.linear());
  q.normalize();
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const Eigen::Vector3d& t = X.translation();
  return fmt::format("{:.6f},{:.6f},{:.6f},{:.8f},{:.8f},{:.8f},{:.8f}", t.x(), t.y(), t.z(), q.w(), q.x(), q.y(),
                     q.z());
}

}  // namespace cgsr::app
