#include "platform/description.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "platform/config/sha256.h"
#include "platform/description/csv.h"
#include "platform/description/digest.h"
#include "platform/description/json.h"
#include "platform/description/markdown.h"
#include "platform/description/text.h"
#include "tests/support/allocation_guard.h"

namespace cgsr {
namespace {

enum class Shade { kLit, kMaybe, kDark };

std::string_view to_string(Shade shade) {
  constexpr std::array<std::string_view, 3> kWords = {"lit", "possibly shaded", "dark"};
  return kWords[static_cast<std::size_t>(shade)];
}

struct Place {
  double x_m = 0.0;
  std::optional<double> sigma_m;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.number("x_m", self.x_m, {3}, "m", "distance to the wall");
    visit.number("sigma_m", self.sigma_m, {2}, "m", "its standard deviation");
  }
};

struct Sight {
  bool found = false;
  float width_px = 0.0F;
  std::uint64_t image = 0;
  Shade shade = Shade::kLit;
  std::string note;
  Place place;
  std::optional<Place> lamp;
  std::vector<Place> balls;

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.flag("found", self.found, "the object is in the image");
    visit.number("width_px", when(self.found, self.width_px), {1}, "px", "width of its box");
    visit.integer("image", self.image, "", "sequence number of the image");
    visit.choice("shade", self.shade, Shade::kDark, "what light falls on it");
    visit.text("note", self.note, "what else there is to say");
    Place::describe(self.place, visit);
    visit.section("lamp", self.lamp, "the lamp that lights it");
    visit.list("balls", self.balls, "every ball");
  }
};

Sight full() {
  Sight sight{true, 12.25F, 7, Shade::kMaybe, "red, \"big\"", {1.0 / 3.0, 0.5}, Place{-2.0, {}}, {}};
  sight.balls = {{1.5, {}}, {2.5, 0.25}};
  return sight;
}

template <class Output>
std::string csv(const Output& output) {
  std::string row;
  append_csv_row(row, output);
  return row;
}

template <class Output>
std::string json(const Output& output) {
  std::string object;
  append_json(object, output);
  return object;
}

template <class Output>
std::string digest(const Output& output) {
  config::Sha256 hash;
  append_to_digest(hash, output);
  return hash.hex();
}

TEST(Description, CsvHasTheNamedColumnsAndTheStatedDecimals) {
  EXPECT_EQ(csv_header<Sight>(), "found,width_px,image,shade,note,x_m,sigma_m,lamp_x_m,lamp_sigma_m,balls");
  EXPECT_EQ(csv(full()), "1,12.2,7,possibly shaded,\"red, \"\"big\"\"\",0.333,0.50,-2.000,,2");
  EXPECT_EQ(csv_header<Place>("cart_"), "cart_x_m,cart_sigma_m");
}

TEST(Description, WhatIsNotThereIsAnEmptyCellAndNoKey) {
  EXPECT_EQ(csv(Sight{}), "0,,0,lit,,0.000,,,,0");
  EXPECT_EQ(json(Sight{}), R"({"found":false,"image":0,"shade":"lit","note":"","x_m":0,"balls":[]})");
}

TEST(Description, NumbersThatAreNotFiniteAreNotThere) {
  for (const double number : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(csv(Place{number, 1.0}), ",1.00");
    EXPECT_EQ(json(Place{number, 1.0}), R"({"sigma_m":1})");
  }
}

TEST(Description, JsonParsesAndBringsTheSameNumbersBack) {
  const auto object = nlohmann::json::parse(json(full()));

  EXPECT_EQ(object["x_m"].get<double>(), 1.0 / 3.0);
  EXPECT_EQ(object["note"], "red, \"big\"");
  EXPECT_EQ(object["lamp"], (nlohmann::json{{"x_m", -2.0}}));
  ASSERT_EQ(object["balls"].size(), 2u);
  EXPECT_EQ(object["balls"][1]["sigma_m"], 0.25);
}

TEST(Description, OneLineForPeopleNamesValuesAndUnits) {
  std::string line;
  append_text(line, full());
  EXPECT_EQ(
      line,
      "found yes, width_px 12.2 px, image 7, shade possibly shaded, note red, \"big\", x_m 0.333 m, sigma_m 0.50 m, "
      "x_m -2.000 m, balls 2");
  line.clear();
  append_text(line, Place{});
  EXPECT_EQ(line, "x_m 0.000 m") << "what is not there is left out";
}

TEST(Description, TextThatIsNotUtf8BecomesValidJson) {
  Sight sight;
  sight.note = "caf\xe9\n";
  EXPECT_EQ(nlohmann::json::parse(json(sight))["note"], "caf\uFFFD\n");
}

TEST(Description, SchemaNamesTypeUnitAndWordsAndRequiresWhatIsAlwaysThere) {
  const auto schema = nlohmann::json::parse(json_schema<Sight>("cgsr/Sight", "What was seen"));

  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema["title"], "cgsr/Sight");
  EXPECT_EQ(schema["type"], "object");
  const auto& fields = schema["properties"];
  EXPECT_EQ(fields["found"]["type"], "boolean");
  EXPECT_EQ(fields["width_px"],
            (nlohmann::json{{"type", "number"}, {"unit", "px"}, {"description", "width of its box [px]"}}));
  EXPECT_EQ(fields["image"]["type"], "integer");
  EXPECT_EQ(fields["shade"]["enum"], (nlohmann::json{"lit", "possibly shaded", "dark"}));
  EXPECT_EQ(fields["lamp"]["properties"]["x_m"]["type"], "number");
  EXPECT_EQ(fields["lamp"]["required"], (nlohmann::json{"x_m"}));
  EXPECT_EQ(fields["balls"]["items"]["properties"]["sigma_m"]["unit"], "m");
  EXPECT_EQ(schema["required"], (nlohmann::json{"found", "image", "shade", "note", "x_m", "balls"}));
}

// Every object that is written obeys the schema of its type: keys, types, words.
void expect_obeys(const nlohmann::json& object, const nlohmann::json& schema) {
  for (const auto& name : schema["required"]) EXPECT_TRUE(object.contains(name)) << name;
  for (const auto& [name, value] : object.items()) {
    ASSERT_TRUE(schema["properties"].contains(name)) << name;
    const auto& field = schema["properties"][name];
    const std::string type = field["type"];
    EXPECT_TRUE(type == value.type_name() || (type == "integer" && value.is_number_integer())) << name;
    if (field.contains("enum")) {
      EXPECT_THAT(field["enum"], testing::Contains(value));
    }
    if (type == "object") expect_obeys(value, field);
    if (type == "array") {
      for (const auto& element : value) expect_obeys(element, field["items"]);
    }
  }
}

TEST(Description, WhatIsWrittenObeysTheSchema) {
  const auto schema = nlohmann::json::parse(json_schema<Sight>("", ""));
  for (const Sight& sight : {Sight{}, full()}) expect_obeys(nlohmann::json::parse(json(sight)), schema);
}

TEST(Description, TheTableForPeopleShowsPathTypeUnitAndMeaning) {
  const std::string table = markdown_fields<Sight>();

  EXPECT_THAT(table, testing::StartsWith("| field | type | unit | meaning |\n"));
  EXPECT_THAT(table, testing::HasSubstr("| `width_px` | number, optional | px | width of its box |\n"));
  EXPECT_THAT(table, testing::HasSubstr("| `shade` | lit, possibly shaded, dark |  | what light falls on it |\n"));
  EXPECT_THAT(table, testing::HasSubstr("| `lamp.x_m` | number | m |"));
  EXPECT_THAT(table, testing::HasSubstr("| `balls[].x_m` | number | m |"));
  EXPECT_THAT(table, testing::EndsWith("| `balls[].sigma_m` | number, optional | m | its standard deviation |\n"));
}

struct Bytes {
  std::vector<int> all;
  void add(const void* bytes, std::size_t count) {
    const auto* first = static_cast<const unsigned char*>(bytes);
    all.insert(all.end(), first, first + count);
  }
};

TEST(Description, TheDigestReadsAFixedBinaryOrder) {
  Bytes bytes;
  append_to_digest(bytes, Place{-2.0, {}});
  EXPECT_THAT(bytes.all, testing::ElementsAre(1, 0, 0, 0, 0, 0, 0, 0, 0xc0, 0));

  bytes.all.clear();
  Sight sight;
  sight.found = true;
  sight.image = 0x0102;
  append_to_digest(bytes, sight);
  bytes.all.resize(2 + 9 + 9);
  EXPECT_THAT(bytes.all, testing::ElementsAre(1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 1, 0, 0, 0, 0, 0, 0));
}

struct Renamed {  // the fields of Place in a section and under other names
  std::optional<Place> inner = Place{1.0, 2.0};

  template <class Self, class Visitor>
  static void describe(Self& self, Visitor& visit) {
    visit.section("inner", self.inner, "regrouped");
  }
};

TEST(Description, TheDigestChangesWithValuesAndNotWithNamesOrGroups) {
  EXPECT_EQ(digest(Renamed{}), digest(Place{1.0, 2.0}));
  EXPECT_NE(digest(Renamed{}), digest(Place{1.0, {}}));
  EXPECT_NE(digest(Renamed{}), digest(Place{2.0, 1.0}));

  const std::string before = digest(full());
  Sight other = full();
  other.note = "in other words";
  EXPECT_EQ(digest(other), before);
  other.balls.pop_back();
  EXPECT_NE(digest(other), before);
  other = full();
  other.balls[1].x_m = std::nextafter(2.5, 3.0);
  EXPECT_NE(digest(other), before);
  other = full();
  other.lamp.reset();
  EXPECT_NE(digest(other), before);
}

TEST(Description, RowsAndDigestsAllocateNothing) {
  if (!test::AllocationGuard::counts()) GTEST_SKIP() << "malloc is not counted under a sanitizer";
  const Sight sight = full();
  struct Count {
    std::size_t bytes = 0;
    void add(const void*, std::size_t count) { bytes += count; }
  } count;
  std::string row = csv(sight) + json(sight);
  row.reserve(1000);
  row.clear();

  const test::AllocationGuard guard;
  append_csv_row(row, sight);
  append_json(row, sight.place);
  append_to_digest(count, sight);

  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(count.bytes, 60u);
}

}  // namespace
}  // namespace cgsr
