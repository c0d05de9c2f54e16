#include "platform/config/document.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace cgsr::config {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& toml) {
  const auto document = Document::parse(toml, "robot.toml");
  return document ? "" : document.error().message;
}

std::string repeated(const std::string& part, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += part;
  return all;
}

TEST(Document, SaysWhereTheTextIsNotToml) {
  EXPECT_THAT(refusal("a = 1\nb = = 2\n"), StartsWith("robot.toml:2: is not TOML: "));
  EXPECT_THAT(refusal("a = 1\n\n[open\n"), StartsWith("robot.toml:3: is not TOML: "));
  EXPECT_THAT(refusal("a = 1\na = 2\n"), StartsWith("robot.toml:2: is not TOML: "));
}

TEST(Document, TakesWhatEditorsLeaveBehind) {
  EXPECT_EQ(refusal("\xEF\xBB\xBF"
                    "a = 1\r\n[b]\r\nc = 2\r\n"),
            "")
      << "byte order mark and CRLF";
  EXPECT_EQ(refusal(""), "");
  EXPECT_EQ(refusal("# nothing but a comment"), "") << "no newline at the end";
}

TEST(Document, RefusesWhatIsNotUtf8) {
  EXPECT_THAT(refusal("a = 1\nb = \"\xFF\xFE\"\n"), StartsWith("robot.toml:2: is not TOML: "));
  EXPECT_THAT(refusal(std::string("a = \"\0\"\n", 8)), HasSubstr("control character"));
}

// Neither the parser nor the destruction of its tree may run out of stack, also under a sanitizer.
TEST(DocumentFault, RefusesEndlessNesting) {
  EXPECT_THAT(refusal("[a" + repeated(".a", 20000) + "]\n"), HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal("a" + repeated(".a", 20000) + " = 1\n"), HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal("a = " + repeated("[", 20000)), HasSubstr("nested"));
  EXPECT_THAT(refusal("a = " + repeated("{a=", 20000)), HasSubstr("nested"));
  EXPECT_EQ(refusal("[a" + repeated(".a", 3900) + "]\n"), "") << "the deepest that is let through is handled";
}

TEST(DocumentFault, RefusesWhatIsTooLarge) {
  EXPECT_EQ(refusal("#" + std::string(Document::kLargestBytes - 1, 'x')), "");
  EXPECT_THAT(refusal("#" + std::string(Document::kLargestBytes, 'x')), HasSubstr("larger than 65536 bytes"));
  const auto endless = Document::load("/dev/zero");
  ASSERT_FALSE(endless);
  EXPECT_THAT(endless.error().message, HasSubstr("larger than"));
}

TEST(DocumentFault, SaysWhyAFileCannotBeRead) {
  const auto missing = Document::load("no/such/robot.toml");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message, "no/such/robot.toml: cannot be opened: No such file or directory");

  const auto folder = Document::load("/");
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().message, HasSubstr("is a folder"));
}

TEST(Document, LoadsAFile) {
  const test::ScratchFolder scratch;
  const auto file = scratch / "document_test.toml";
  std::ofstream(file) << "a = 1\n";
  const auto document = Document::load(file);
  ASSERT_TRUE(document) << document.error().message;
  EXPECT_EQ(document->name(), file.string());
}

TEST(PathBeside, StartsAtTheFolderOfTheFile) {
  EXPECT_EQ(path_beside("config/robots/home.toml", "models/ball.model"), "config/robots/models/ball.model");
  EXPECT_EQ(path_beside("config/robots/home.toml", "../worlds/home.toml"), "config/worlds/home.toml");
  EXPECT_EQ(path_beside("home.toml", "ball.model"), "ball.model");
  EXPECT_EQ(path_beside("config/home.toml", "/var/ball.model"), "/var/ball.model");
  EXPECT_EQ(path_beside("config/home.toml", ""), "");
}

}  // namespace
}  // namespace cgsr::config
