#include "src/input/identities_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

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
  std::vector<fs::path> aside;
  for (const std::string& bad : {std::string(), good.substr(0, good.size() / 2), flipped}) {
    write(bad);
    fs::permissions(file_, fs::perms::all);
    const auto read = load_identities(file_);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("damaged"), std::string::npos) << read.error().message;
    auto edit = IdentitiesEdit::open(file_);
    ASSERT_TRUE(edit) << edit.error().message;
    EXPECT_TRUE(edit->identities().people.empty());
    EXPECT_EQ(bytes(), bad) << "as long as nothing is written everything stays";
    edit->identities() = some(1);
    const auto note = edit->save();
    ASSERT_TRUE(note) << note.error().message;
    aside.emplace_back(file_.string() + fmt::format(".damaged-{}", aside.size() + 1));
    EXPECT_EQ(fs::file_size(aside.back()), bad.size());
    EXPECT_EQ(fs::status(aside.back()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_NE(note->find(aside.back().string()), std::string::npos) << *note;
    ASSERT_TRUE(load_identities(file_));
  }
  EXPECT_EQ(kept_aside(file_), aside);
  fs::remove(aside.front());
  EXPECT_EQ(kept_aside(file_).size(), aside.size() - 1) << "also where one was deleted";
}

// Somebody names the robot's file instead.
TEST_F(IdentitiesFile, LeavesAnothersFileWhereItIs) {
  write("[task]\nkind = \"person\"\n");
  const auto edit = IdentitiesEdit::open(file_);
  ASSERT_FALSE(edit);
  EXPECT_NE(edit.error().message.find("no identities file: it is something else"), std::string::npos)
      << edit.error().message;
  EXPECT_EQ(bytes(), "[task]\nkind = \"person\"\n");
}

TEST_F(IdentitiesFile, WritesWhatALinkPointsTo) {
  ASSERT_TRUE(save_identities(some(2), file_));
  const fs::path link = folder_ / "link.cbor";
  fs::create_symlink(file_, link);
  auto edit = IdentitiesEdit::open(link);
  ASSERT_TRUE(edit) << edit.error().message;
  edit->identities().people.pop_back();
  ASSERT_TRUE(edit->save());
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(load_identities(file_)->people.size(), 1U);
}

TEST_F(IdentitiesFile, LetsOneAfterTheOtherChangeIt) {
  ASSERT_TRUE(save_identities(person::Identities{}, file_));
  const auto add_some = [this] {
    for (int i = 0; i < 20; ++i) {
      auto edit = IdentitiesEdit::open(file_);
      ASSERT_TRUE(edit) << edit.error().message;
      person::Identities& all = edit->identities();
      all.people.push_back({all.next_number++, "somebody", {}});
      ASSERT_TRUE(edit->save());
    }
  };
  std::thread one(add_some), other(add_some);
  one.join();
  other.join();
  const auto all = load_identities(file_);
  ASSERT_TRUE(all) << all.error().message;
  EXPECT_EQ(all->people.size(), 40U);
  EXPECT_EQ(all->next_number, 41);
}

TEST_F(IdentitiesFile, RefusesANameThatItWouldNotReadAgain) {
  for (const std::string& name : {std::string(), std::string(300, 'a'), std::string("two\nlines")}) {
    EXPECT_TRUE(name_problem(name));
    person::Identities identities = some(1);
    identities.people.front().name = name;
    EXPECT_FALSE(save_identities(identities, file_));
    EXPECT_FALSE(fs::exists(file_));
  }
  EXPECT_FALSE(name_problem("Zo\xC3\xAB"));
}

// A parser that recurses would exhaust its stack.
TEST_F(IdentitiesFile, RefusesADeeplyNestedOne) {
  for (const char head : {'\x9F', '\x7F'}) {
    write(
        "\xA2\x66"  // a map of two: its format and
        "format\x6F"
        "cgsr identities\x67"
        "payload" +
        std::string(4U << 20, head));
    const auto read = load_identities(file_);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().message.find("offset 47: an item that holds others is 17 deep, expected at most 16"),
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
