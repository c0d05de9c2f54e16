#include "src/input/identities_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "platform/config/sha256.h"

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

std::vector<std::uint8_t> checksum_of(const std::vector<std::uint8_t>& bytes) {
  const std::string digits = config::sha256({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  std::vector<std::uint8_t> sum;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    sum.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  return sum;
}

/// Some bytes changed, taken out, put in or cut off.
std::vector<std::uint8_t> damaged(std::vector<std::uint8_t> bytes, std::mt19937& random) {
  const auto below = [&random](std::size_t count) { return random() % std::max<std::size_t>(count, 1); };
  const auto place = [&] {
    return bytes.begin() + static_cast<std::ptrdiff_t>(below(std::min<std::size_t>(bytes.size(), 160)));
  };
  for (std::size_t changes = 1 + below(3); changes > 0 && !bytes.empty(); --changes) {
    switch (below(4)) {
      case 0:
        *place() = static_cast<std::uint8_t>(random());
        break;
      case 1:
        bytes.erase(place());
        break;
      case 2:
        bytes.insert(place(), static_cast<std::uint8_t>(random()));
        break;
      default:
        bytes.resize(below(bytes.size()));
    }
  }
  return bytes;
}

// Where the checksum fits too, as where somebody made the file on purpose.
TEST_F(IdentitiesFile, IsReadOrRefusedWithTheReasonWhateverItHolds) {
  constexpr int kFiles = 400;
  ASSERT_TRUE(save_identities(some(2), file_));
  const std::string good = bytes();
  const auto sound = nlohmann::json::from_cbor(good);
  const std::vector<std::uint8_t> payload = sound.at("payload").get_binary();
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < kFiles; ++i) {
    std::vector<std::uint8_t> file;
    if (i % 3 == 0) {
      file = damaged({good.begin(), good.end()}, random);
    } else {
      const auto changed = damaged(payload, random);
      auto whole = sound;
      whole["payload"] = nlohmann::json::binary(changed);
      whole["sha256"] = nlohmann::json::binary(checksum_of(changed));
      file = nlohmann::json::to_cbor(whole);
    }
    write({file.begin(), file.end()});
    const auto read = load_identities(file_);
    refused += read ? 0 : 1;
    if (read) {
      for (const auto& one : read->people) EXPECT_FALSE(name_problem(one.name)) << one.name;
    } else {
      EXPECT_FALSE(read.error().message.empty());
    }
  }
  EXPECT_GT(refused, kFiles / 2) << "the changes hit what matters";
}

TEST_F(IdentitiesFile, RefusesOneOfAnOlderVersionWithWhatToDo) {
  ASSERT_TRUE(save_identities(some(1), file_));
  auto file = nlohmann::json::from_cbor(bytes());
  file["version"] = kIdentitiesVersion - 1;
  const auto older = nlohmann::json::to_cbor(file);
  write({older.begin(), older.end()});
  const auto read = load_identities(file_);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("remove the file and enrol its people again"), std::string::npos)
      << read.error().message;
  EXPECT_FALSE(IdentitiesEdit::open(file_)) << "it stays until somebody removes it";
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
