#include <array>
#include <cctype>
#include <filesystem>
#include <random>
#include <regex>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "platform/config/canonical.h"
#include "platform/config/reader.h"
#include "src/config/robot.h"
#include "tests/config/audit.h"
#include "tests/config/sample.h"

namespace cgsr::config {
namespace {

using Random = std::mt19937_64;

std::size_t below(Random& random, std::size_t bound) {
  return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
}

/// One small damage: bytes changed, removed, inserted, a piece repeated, two pieces swapped, or a word of the format put in.
std::string damaged(std::string text, Random& random) {
  static const std::string kWords[] = {"nan",
                                       "-inf",
                                       "[",
                                       "]",
                                       "{",
                                       "}",
                                       "\"",
                                       "'''",
                                       "=",
                                       ".",
                                       "#",
                                       "\n",
                                       "\\u0000",
                                       "0x",
                                       "9223372036854775808",
                                       "1e999",
                                       "-0.0",
                                       "true",
                                       "1979-05-27",
                                       "[[stage]]\n",
                                       "[stage.track]\n",
                                       "stage.track.budget_us = 1\n",
                                       "\xFF",
                                       "\xE2\x82",
                                       "\r"};
  if (text.empty()) return "x";
  const std::size_t at = below(random, text.size());
  const std::size_t length = 1 + below(random, 12);
  switch (below(random, 6)) {
    case 0:
      text[at] = static_cast<char>(below(random, 256));
      break;
    case 1:
      text.erase(at, length);
      break;
    case 2:
      text.insert(at, 1, static_cast<char>(below(random, 256)));
      break;
    case 3:
      text.insert(below(random, text.size()), text.substr(at, 10 * length));
      break;
    case 4:
      text.insert(at, kWords[below(random, std::size(kWords))]);
      break;
    case 5:
      text.replace(at, length, kWords[below(random, std::size(kWords))]);
      break;
  }
  return text;
}

/// Every line of a refusal names the file, nearly always with a line, and says something.
bool is_clear(const std::string& message) {
  static const std::regex kForm("robot\\.toml(:[0-9]+)?: .{5,}");
  std::istringstream lines(message);
  bool any = false;
  for (std::string line; std::getline(lines, line); any = true) {
    if (!std::regex_match(line, kForm)) return false;
    for (const char c : line) {
      if (std::iscntrl(static_cast<unsigned char>(c)) != 0) return false;
    }
  }
  return any;
}

/// Damages `valid` over and over: each time there is a clear refusal, or parameters that are within their ranges.
template <class Parameters>
void survive(const std::string& valid, int trials, std::uint64_t seed) {
  const auto undamaged = Document::parse(valid, "robot.toml");
  ASSERT_TRUE(undamaged && read<Parameters>(*undamaged)) << "what is damaged must be good";
  Random random(seed);
  int refused = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::string text = valid;
    for (std::size_t blows = 1 + below(random, 4); blows > 0; --blows) text = damaged(text, random);

    const auto document = Document::parse(text, "robot.toml");
    const auto parameters =
        document ? read<Parameters>(*document) : Result<Parameters>(tl::unexpected(document.error()));
    if (parameters) {
      ASSERT_THAT(audit(*parameters), testing::IsEmpty()) << trial << '\n' << text;
    } else {
      ++refused;
      ASSERT_TRUE(is_clear(parameters.error().message)) << trial << '\n' << parameters.error().message;
    }
  }
  EXPECT_GT(refused, trials / 10);
}

TEST(ReaderProperty, DamagedSampleIsRefusedOrValid) {
  survive<Sample>(std::string(kWholeSample), 10000, 20261121);
}

TEST(ReaderProperty, DamagedRobotIsRefusedOrValid) {
  survive<Robot>(canonical(Robot()), 3000, 7);
}

/// Draws every value from its range.
class Draw {
 public:
  explicit Draw(Random& random) : random_(random) {}
  void number(std::string_view, int& value, Range<int> range, std::string_view, std::string_view) {
    value = std::uniform_int_distribution<int>(range.minimum, range.maximum)(random_);
  }
  void number(std::string_view, double& value, Range<double> range, std::string_view, std::string_view) {
    value = std::uniform_real_distribution<double>(range.minimum, range.maximum)(random_);
  }
  template <std::size_t kCount>
  void numbers(std::string_view name, std::array<double, kCount>& values, Range<double> range, std::string_view unit,
               std::string_view description) {
    for (double& value : values) number(name, value, range, unit, description);
  }
  void flag(std::string_view, bool& value, std::string_view) { value = below(random_, 2) == 1; }
  void text(std::string_view, std::string& value, std::string_view) {
    static const std::string kLetters[] = {"a", "\"", "\\", "\n", "\t", "#", "'", "µ", "漢", "\x7F", "\x01", "="};
    value.clear();
    for (std::size_t length = below(random_, 8); length > 0; --length) value += kLetters[below(random_, 12)];
  }
  void path(std::string_view name, std::string& value, std::string_view meaning) {
    do {
      text(name, value, meaning);
    } while (value != std::filesystem::path(value).lexically_normal().string());  // as the reader leaves it
  }
  template <class Enum, class Names>
  void choice(std::string_view, Enum& value, const Names& names, std::string_view) {
    value = names[below(random_, std::size(names))].value;
  }
  template <class Struct>
  void section(std::string_view, Struct& value, std::string_view) {
    do {
      Struct::describe(value, *this);
    } while (disagrees(value));
  }

 private:
  template <class Struct>
  static bool disagrees(const Struct& value) {
    if constexpr (requires { value.inconsistency(); }) return !value.inconsistency().empty();
    return false;
  }
  Random& random_;
};

template <class Parameters>
void come_back(int trials, std::uint64_t seed) {
  Random random(seed);
  for (int trial = 0; trial < trials; ++trial) {
    Parameters drawn;
    Draw(random).section("", drawn, "");

    const std::string text = canonical(drawn);
    const auto document = Document::parse(text, "robot.toml");
    ASSERT_TRUE(document) << document.error().message << '\n' << text;
    const auto parameters = read<Parameters>(*document);
    ASSERT_TRUE(parameters) << parameters.error().message << '\n' << text;
    ASSERT_EQ(canonical(*parameters), text) << trial;
  }
}

// What is written in canonical form reads back to the same values, bit for bit, with no key missing.
TEST(CanonicalProperty, ReadsBackTheSame) {
  come_back<Sample>(2000, 1);
  come_back<Robot>(500, 2);
}

}  // namespace
}  // namespace cgsr::config
