#include "platform/cpu_pin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace cgsr {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string output_of_probe(const std::string& environment, const std::string& arguments) {
  const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const auto command = environment + " '" + (folder / "cpu_pin_probe").string() + "' " + arguments;
  FILE* const pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
  pclose(pipe);
  return text;
}

TEST(CpuPin, StartsTheProgramAgainWithThePinnedEnvironment) {
  const auto output = output_of_probe("exec env -u CGSR_CPU_PINNED OPENCV_CPU_DISABLE=", "one 'two words'");
  EXPECT_THAT(output, HasSubstr("same process: 1\n"));
  EXPECT_THAT(output, HasSubstr("argument: one\nargument: two words\n"));
  EXPECT_THAT(output, HasSubstr("OPENCV_CPU_DISABLE: 1\n"));
  EXPECT_THAT(output, HasSubstr("GLIBC_TUNABLES: 1\n"));
  EXPECT_THAT(output, Not(HasSubstr(": 0\n")));
}

// tools/count and valgrind set the variables outside: then there is no second start.
TEST(CpuPin, StaysWhereTheEnvironmentIsRightAlready) {
  std::string environment = "exec env -u CGSR_CPU_PINNED";
  for (const auto& [name, value] : pinned_environment()) environment += " " + name + "=" + value;
  const auto output = output_of_probe(environment, "");
  EXPECT_THAT(output, HasSubstr("same process: 0\n")) << "the probe notes its number only when it is started twice";
  EXPECT_THAT(output, HasSubstr("GLIBC_TUNABLES: 1\n"));
}

TEST(CpuPin, DoesNotStartAgainForEver) {
  const auto output = output_of_probe("CGSR_CPU_PINNED=1 OPENCV_CPU_DISABLE=", "");
  EXPECT_THAT(output, HasSubstr("refused: the instruction set is not pinned"));
}

}  // namespace
}  // namespace cgsr
