#include "platform/replace_file.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace cgsr {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

/// While it lives, no file of this process may have more than `bytes`: a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, SIG_DFL);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
};

TEST(ReplaceFile, WritesAllPartsAndLeavesNothingBesideIt) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(replace_file(scratch / "a", {"one ", "two"}));
  EXPECT_EQ(text_of(scratch / "a"), "one two");
  ASSERT_TRUE(replace_file(scratch / "a", {"three"}));
  EXPECT_EQ(text_of(scratch / "a"), "three");
  EXPECT_EQ(files_in(scratch / ""), 1);
}

TEST(ReplaceFile, IsANewFileUnderTheOldNameWithItsPermissions) {
  const test::ScratchFolder scratch;
  put(scratch / "a", "old");
  fs::permissions(scratch / "a", fs::perms::owner_read | fs::perms::owner_write);
  std::ifstream reader(scratch / "a");
  ASSERT_TRUE(replace_file(scratch / "a", {"new"}));
  std::string seen;
  reader >> seen;
  EXPECT_EQ(seen, "old");  // who had it open reads on in the old one
  EXPECT_EQ(fs::status(scratch / "a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(ReplaceFile, WritesThroughALinkAndADevice) {
  const test::ScratchFolder scratch;
  put(scratch / "far", "old and longer");
  fs::create_symlink("far", scratch / "link");
  ASSERT_TRUE(replace_file(scratch / "link", {"new"}));
  EXPECT_TRUE(fs::is_symlink(scratch / "link"));
  EXPECT_EQ(text_of(scratch / "far"), "new");

  fs::create_symlink("nowhere yet", scratch / "dangling");
  ASSERT_TRUE(replace_file(scratch / "dangling", {"new"}));
  EXPECT_TRUE(fs::is_symlink(scratch / "dangling"));
  EXPECT_EQ(text_of(scratch / "nowhere yet"), "new");

  EXPECT_TRUE(replace_file("/dev/null", {"new"}));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));

  ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
  const int reader = open((scratch / "pipe").c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_TRUE(replace_file(scratch / "pipe", {"new"}));
  char text[4] = {};
  EXPECT_EQ(read(reader, text, 3), 3);
  EXPECT_STREQ(text, "new");
  close(reader);
  EXPECT_TRUE(fs::is_fifo(scratch / "pipe"));
}

TEST(ReplaceFileFault, AFullDiskLeavesTheOldContent) {
  const test::ScratchFolder scratch;
  put(scratch / "a", "old");
  {
    const FullDisk full(1000);
    const auto written = replace_file(scratch / "a", {std::string(2000, 'x')});
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message, HasSubstr("/a: cannot be written: File too large"));
  }
  EXPECT_EQ(text_of(scratch / "a"), "old");
  EXPECT_EQ(files_in(scratch / ""), 1);

  const auto device = replace_file("/dev/full", {"new"});
  ASSERT_FALSE(device);
  EXPECT_THAT(device.error().message, HasSubstr("/dev/full: cannot be written: No space left on device"));
}

TEST(ReplaceFileFault, AFolderOfThatNameAndAMissingFolder) {
  const test::ScratchFolder scratch;
  fs::create_directory(scratch / "a");
  const auto over_folder = replace_file(scratch / "a", {"new"});
  ASSERT_FALSE(over_folder);
  EXPECT_THAT(over_folder.error().message, HasSubstr("/a: cannot be put in place: Is a directory"));
  const auto nowhere = replace_file(scratch / "b" / "a", {"new"});
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(nowhere.error().message, HasSubstr("/b/a: cannot be written: No such file"));
  EXPECT_EQ(files_in(scratch / ""), 1);
}

TEST(CheckWritable, ChangesNothing) {
  const test::ScratchFolder scratch;
  put(scratch / "a", "old");
  fs::create_symlink("a", scratch / "link");
  fs::create_symlink("nowhere yet", scratch / "dangling");
  ASSERT_EQ(mkfifo((scratch / "pipe").c_str(), 0600), 0);
  const auto before = fs::last_write_time(scratch / "a");
  for (const char* name : {"a", "link", "dangling", "new", "pipe"}) EXPECT_TRUE(check_writable(scratch / name)) << name;
  EXPECT_TRUE(check_writable("/dev/null"));
  EXPECT_EQ(text_of(scratch / "a"), "old");
  EXPECT_EQ(fs::last_write_time(scratch / "a"), before);
  EXPECT_EQ(files_in(scratch / ""), 4);
}

TEST(CheckWritableFault, NamesWhatSpeaksAgainstIt) {
  const test::ScratchFolder scratch;
  fs::create_directory(scratch / "folder");
  fs::create_symlink("folder/missing/a", scratch / "dangling");
  EXPECT_THAT(check_writable(scratch / "folder").error().message, HasSubstr("/folder: is a folder: expected"));
  EXPECT_THAT(check_writable(scratch / "no/a").error().message, HasSubstr("/no/a: cannot be written: No such file"));
  EXPECT_THAT(check_writable(scratch / "dangling").error().message, HasSubstr("No such file"));
  EXPECT_THAT(check_writable("/proc/self/a").error().message, HasSubstr("/proc/self/a: cannot be written"));
}

}  // namespace
}  // namespace cgsr
