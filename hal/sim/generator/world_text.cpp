#include "hal/sim/generator/world_text.h"

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "platform/parameters.h"

namespace cgsr::sim {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

std::string number_text(int value) {
  return std::to_string(value);
}

/// The shortest that reads back; with a point, so that it stays a float.
std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

/// What a struct of a world file says of itself, as lines: a visitor of describe().
class Scalars {
 public:
  template <class Spec>
  static std::vector<std::string> of(const Spec& spec) {
    Scalars scalars;
    Spec::describe(spec, scalars);
    return scalars.lines_;
  }

  void line(int /*value*/) {}
  template <class T>
  void number(std::string_view name, const T& value, Range<T> /*range*/, std::string_view /*unit*/,
              std::string_view /*meaning*/) {
    add(name, number_text(value));
  }
  void number(std::string_view name, const double& value, Range<double> /*range*/, std::string_view /*unit*/,
              std::string_view /*meaning*/) {
    add(name, number_text(value));
  }
  void numbers(std::string_view name, const Triple& value, Range<double> /*range*/, std::string_view /*unit*/,
               std::string_view /*meaning*/) {
    add(name, fmt::format("[{}, {}, {}]", number_text(value[0]), number_text(value[1]), number_text(value[2])));
  }
  void flag(std::string_view name, const bool& value, std::string_view /*meaning*/) {
    add(name, value ? "true" : "false");
  }
  void text(std::string_view name, const std::string& value, std::string_view /*meaning*/) { add(name, quoted(value)); }
  template <class Enum, std::size_t kCount>
  void choice(std::string_view name, const Enum& value, const Named<Enum> (&table)[kCount],
              std::string_view /*meaning*/) {
    for (const Named<Enum>& named : table) {
      if (named.value == value) add(name, quoted(std::string(named.name)));
    }
  }
  template <class Spec>
  void section(std::string_view /*name*/, const Spec& /*value*/, std::string_view /*meaning*/) {}
  template <class Spec>
  void list(std::string_view /*name*/, const std::vector<Spec>& /*value*/, std::string_view /*meaning*/) {}

 private:
  void add(std::string_view name, const std::string& value) { lines_.push_back(fmt::format("{} = {}\n", name, value)); }

  std::vector<std::string> lines_;
};

template <class Spec>
void write(const Spec& spec, const std::string& path, std::string& out);

/// The sections and lists of a struct, below `path`: the other visitor.
class Tables {
 public:
  Tables(std::string path, std::string& out) : path_(std::move(path)), out_(&out) {}

  template <class... Ignored>
  void line(const Ignored&... /*ignored*/) {}
  template <class T>
  void number(std::string_view /*name*/, const T& /*value*/, Range<T> /*range*/, std::string_view /*unit*/,
              std::string_view /*meaning*/) {}
  void numbers(std::string_view /*name*/, const Triple& /*value*/, Range<double> /*range*/, std::string_view /*unit*/,
               std::string_view /*meaning*/) {}
  void flag(std::string_view /*name*/, const bool& /*value*/, std::string_view /*meaning*/) {}
  void text(std::string_view /*name*/, const std::string& /*value*/, std::string_view /*meaning*/) {}
  template <class Enum, std::size_t kCount>
  void choice(std::string_view /*name*/, const Enum& /*value*/, const Named<Enum> (&/*table*/)[kCount],
              std::string_view /*meaning*/) {}
  template <class Spec>
  void section(std::string_view name, const Spec& value, std::string_view /*meaning*/) {
    const std::string path = below(name);
    std::string inside;
    write(value, path, inside);
    if (!inside.empty()) *out_ += fmt::format("\n[{}]\n{}", path, inside);
  }
  template <class Spec>
  void list(std::string_view name, const std::vector<Spec>& values, std::string_view /*meaning*/) {
    const std::string path = below(name);
    for (const Spec& value : values) {
      *out_ += fmt::format("\n[[{}]]\n", path);
      write(value, path, *out_);
    }
  }

 private:
  [[nodiscard]] std::string below(std::string_view name) const {
    return path_.empty() ? std::string(name) : fmt::format("{}.{}", path_, name);
  }

  std::string path_;
  std::string* out_;
};

template <class Spec>
void write(const Spec& spec, const std::string& path, std::string& out) {
  const std::vector<std::string> said = Scalars::of(spec);
  const std::vector<std::string> usual = Scalars::of(Spec{});
  for (std::size_t i = 0; i < said.size(); ++i) {
    if (said[i] != usual[i]) out += said[i];
  }
  Tables tables(path, out);
  Spec::describe(spec, tables);
}

}  // namespace

std::string world_as_toml(const WorldSpec& world, const std::string& comment) {
  std::string out = fmt::format("# {}\n", comment);
  for (std::size_t at = 2; (at = out.find('\n', at)) + 1 < out.size(); at += 3) out.replace(at, 1, "\n# ");
  write(world, "", out);
  return out;
}

}  // namespace cgsr::sim
