#include "src/output/output_claims.h"

#include <sys/stat.h>

#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace cgsr::app {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::HasSubstr;

class Claims : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(scratch_ / name, std::ios::binary) << text;
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream file(scratch_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Why an output is refused beside an input that is called `read`; empty: it is not.
  [[nodiscard]] std::string refusal(const std::string& output, const FileKind& kind, bool force = false) const {
    OutputClaims files(force);
    files.reads(scratch_ / "read", "--input");
    files.writes(scratch_ / output, "--csv", kind);
    const auto claimed = files.claim();
    return claimed ? "" : claimed.error().message;
  }

  test::ScratchFolder scratch_;
};

TEST_F(Claims, LeaveNoFileBehind) {
  EXPECT_EQ(refusal("new.csv", csv_file("frame,found")), "");
  EXPECT_FALSE(fs::exists(scratch_ / "new.csv"));
  OutputClaims none(false);
  none.reads("", "--input");
  none.writes("", "--csv", csv_file("frame"));
  EXPECT_TRUE(none.claim());
}

TEST_F(Claims, RefuseAnInputByAnyNameEvenByForce) {
  put("read", "frame,found\n");
  fs::create_directory(scratch_ / "folder");
  fs::create_symlink("read", scratch_ / "link");
  fs::create_hard_link(scratch_ / "read", scratch_ / "hard");
  for (const char* name : {"read", "link", "hard", "folder/../read"}) {
    for (const bool force : {false, true}) {
      EXPECT_THAT(refusal(name, csv_file("frame,found"), force), HasSubstr("is read as --input (")) << name << force;
    }
  }
  EXPECT_EQ(text_of("read"), "frame,found\n");
}

TEST_F(Claims, RefuseAnImageOfTheFolderThatIsRead) {
  fs::create_directory(scratch_ / "read");
  put("read/0.png", "\x89PNG\r\n\x1A\n");
  put("read/notes.csv", "frame,found\n");
  EXPECT_THAT(refusal("read/0.png", picture_file(), true), HasSubstr("is read as --input"));
  EXPECT_EQ(refusal("read/new.png", picture_file()), "");
  EXPECT_EQ(refusal("read/notes.csv", csv_file("frame,found")), "");
}

TEST_F(Claims, RefuseOneFileForTwoOutputs) {
  fs::create_symlink("a", scratch_ / "b");  // to what is not there yet
  OutputClaims files(true);
  files.writes(scratch_ / "a", "--csv", csv_file("frame"));
  files.writes(scratch_ / "b", "--json", json_object());
  const auto claimed = files.claim();
  ASSERT_FALSE(claimed);
  EXPECT_THAT(claimed.error().message, HasSubstr("--json "));
  EXPECT_THAT(claimed.error().message, HasSubstr("is the output of --csv too"));
  OutputClaims devices(false);
  devices.writes("/dev/null", "--csv", csv_file("frame"));
  devices.writes("/dev/null", "--json", json_object());
  EXPECT_TRUE(devices.claim());
}

TEST_F(Claims, RefuseAnotherKindOfFileWithoutForce) {
  put("thesis.tex", "\\documentclass{article}\n");
  put("empty", "");
  EXPECT_THAT(refusal("thesis.tex", json_object()), HasSubstr("exists and is not a JSON object; it is not replaced"));
  EXPECT_EQ(refusal("thesis.tex", json_object(), true), "");
  EXPECT_EQ(refusal("empty", json_object()), "");
  fs::create_symlink("thesis.tex", scratch_ / "link");
  EXPECT_THAT(refusal("link", json_object()), HasSubstr("exists and is not"));
  EXPECT_EQ(text_of("thesis.tex"), "\\documentclass{article}\n");
}

TEST_F(Claims, RefuseANameOfAnotherEnding) {
  EXPECT_THAT(refusal("a.txt", video_file()), HasSubstr("/a.txt: expected the name of a video to end in .avi, .mkv"));
  EXPECT_THAT(refusal("a", picture_file(), true), HasSubstr("/a: expected the name of a picture to end in .png"));
  EXPECT_EQ(refusal("a.MKV", video_file()), "");
}

TEST_F(Claims, RefuseWhatCannotBeWritten) {
  fs::create_directory(scratch_ / "folder");
  EXPECT_THAT(refusal("folder", json_object(), true), HasSubstr("/folder: is a folder"));
  EXPECT_THAT(refusal("missing/a", json_object(), true), HasSubstr("/missing/a: cannot be written"));
  ASSERT_EQ(mkfifo((scratch_ / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(refusal("pipe", json_object()), "");
}

TEST(FileKinds, KnowTheirOwnAndNoOther) {
  const std::vector<std::pair<FileKind, std::string>> own = {
      {csv_file("frame,found,x"), "frame,found,x\n0,1,2\n"},
      {json_object(), "{\n \"images\": 3}"},
      {json_list(), "[{\"name\": 1}]"},
      {mcap_file(), "\x89MCAP0\r\n"},
      {video_file(), "\x1A\x45\xDF\xA3...."},
      {picture_file(), "\xFF\xD8\xFF\xE0"},
      {compact_map(), "CGSRMAP\0\1"s},
      {color_model(),
       "\xA4\x66"
       "format\x71"
       "cgsr colour model"},
      {camera_yaml(), "image_width: 640\ncamera_matrix:\n"},
      {html_page(), "<!doctype html>\n<html>"},
      {toml_with({"mount", "board"}), "# measured\n[mount]\nposition_m = [ 1 ]\n\n[board]\n[[board]]\n"},
      {same_text("as it was\n"), "as it was\n"},
      {text_beginning("# Keys"), "# Keys of a robot's file\n"},
  };
  for (std::size_t kind = 0; kind < own.size(); ++kind) {
    for (std::size_t text = 0; text < own.size(); ++text) {
      EXPECT_EQ(own[kind].first.is(own[text].second), kind == text) << own[kind].first.name << " of " << text;
    }
    EXPECT_FALSE(own[kind].first.is("any text\nof a user\n")) << own[kind].first.name;
  }
}

TEST(FileKinds, ACsvFileMayHaveColumnsAppended) {
  const FileKind csv = csv_file("frame,found");
  EXPECT_TRUE(csv.is("frame,found,x\n"));
  EXPECT_TRUE(csv.is("frame\r\n"));
  EXPECT_FALSE(csv.is("frame,founder\n"));
  EXPECT_FALSE(csv.is("\n"));
}

TEST(FileKinds, ATomlFileWithMoreThanOursIsAUsers) {
  const FileKind toml = toml_with({"mount"});
  EXPECT_FALSE(toml.is("[mount]\nposition_m = 1\n[camera]\nkind = 1\n"));
  EXPECT_FALSE(toml.is("extends = \"a\"\n[mount]\n"));
  EXPECT_FALSE(toml.is("# nothing\n"));
}

}  // namespace
}  // namespace cgsr::app
