#include "src/input/identities_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace cgsr::app {
namespace {

namespace fs = std::filesystem;

class IdentitiesFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("cgsr-identities-{}", getpid());
    fs::create_directories(folder_);
    file_ = folder_ / "people.cbor";
  }
  void TearDown() override { fs::remove_all(folder_); }

  static person::Identities some(int people) {
    person::Identities all;
    for (int i = 0; i < people; ++i) {
      person::FaceView view{};
      view.fill(static_cast<std::uint8_t>(i));
      all.people.push_back({all.next_number++, fmt::format("person {}", i), {view, view}});
    }
    return all;
  }
  [[nodiscard]] std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write(const std::string& text) const { std::ofstream(file_, std::ios::binary) << text; }

  fs::path folder_, file_;
};

TEST_F(IdentitiesFile, GivesBackWhatWasWritten) {
  const auto written = some(3);
  ASSERT_TRUE(save_identities(written, file_));
  const auto read = load_identities(file_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->next_number, 4);
  ASSERT_EQ(read->people.size(), 3U);
  EXPECT_EQ(read->people[2].name, "person 2");
  EXPECT_EQ(read->people[2].number, 3);
  EXPECT_EQ(read->people[2].views, written.people[2].views);
}

TEST_F(IdentitiesFile, IsReadableByItsOwnerAloneAlsoWhereItWasNot) {
  write("");
  fs::permissions(file_, fs::perms::all);
  ASSERT_TRUE(save_identities(some(1), file_));
  EXPECT_EQ(fs::status(file_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "nothing is left beside it";
}

TEST_F(IdentitiesFile, IsEmptyWhereThereIsNone) {
  const auto read = load_identities(file_);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->people.empty());
}

TEST_F(IdentitiesFile, RefusesEveryDamageAndKeepsTheFileAside) {
  ASSERT_TRUE(save_identities(some(2), file_));
  const std::string good = bytes();
  std::string flipped = good;
  flipped[flipped.size() / 2] ^= 1;
  int aside = 0;
  for (const std::string& bad : {std::string("not CBOR"), std::string(), good.substr(0, good.size() / 2), flipped}) {
    write(bad);
    const auto read = load_identities(file_);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("damaged"), std::string::npos) << read.error().message;
    EXPECT_EQ(bytes(), bad) << "reading changes nothing";
    const auto opened = open_identities(file_);
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_TRUE(opened->identities.people.empty());
    const fs::path kept = file_.string() + fmt::format(".damaged-{}", ++aside);
    EXPECT_TRUE(fs::exists(kept));
    EXPECT_EQ(fs::file_size(kept), bad.size());
    EXPECT_NE(opened->note.find(kept.string()), std::string::npos);
    EXPECT_FALSE(fs::exists(file_));
  }
}

// A parser that recurses would exhaust its stack.
TEST_F(IdentitiesFile, RefusesADeeplyNestedOne) {
  for (const char head : {'\x9F', '\x7F'}) {
    write(std::string(4U << 20, head));
    const auto read = load_identities(file_);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("offset 16: an item that holds others is 17 deep, expected at most 16"),
              std::string::npos)
        << read.error().message;
  }
}

// Text that is taken for CBOR of another type too.
TEST_F(IdentitiesFile, SaysOfAnotherFileThatItIsNone) {
  write("garbage\n");
  const auto read = load_identities(file_);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("it is something else"), std::string::npos) << read.error().message;
}

TEST_F(IdentitiesFile, KeepsAThousandPeople) {
  ASSERT_TRUE(save_identities(some(1000), file_));
  const auto read = load_identities(file_);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->people.size(), 1000U);
}

TEST_F(IdentitiesFile, SaysWhereItCannotBeWritten) {
  const auto saved = save_identities(some(1), folder_ / "nowhere" / "people.cbor");
  ASSERT_FALSE(saved);
  EXPECT_NE(saved.error().message.find("No such file"), std::string::npos) << saved.error().message;
}

}  // namespace
}  // namespace cgsr::app
