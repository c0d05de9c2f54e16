#include "pipeline/color/learn/model_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/sha.h>
#include <sys/stat.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

#include <nlohmann/json.hpp>

#include "pipeline/color/learn/learn.h"
#include "tests/color/scene.h"

namespace cgsr::color {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

ColorModel flag_model() {
  test::Painting painting(160, 120);
  painting.paint([](int x, int) { return x < 80 ? imaging::Rgb{0.3, 0.5, 0.3} : imaging::Rgb{0.6, 0.6, 0.5}; });
  const Box box{60, 30, 36, 48};
  test::paint_flag(painting, box);
  const Sample sample{painting.photograph(1.0), box};
  return learn({&sample, 1}, {}).value().model;
}

class ModelFile : public ::testing::Test {
 protected:
  ModelFile()
      : folder_(std::filesystem::temp_directory_path() / ("cgsr_model_" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directory(folder_);
  }
  ~ModelFile() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name = "object.model") const { return (folder_ / name).string(); }
  [[nodiscard]] Bytes read() const {
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void write(const Bytes& bytes) const {
    std::ofstream file(path(), std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  [[nodiscard]] std::string refusal() const {
    const auto model = load_model(path());
    return model ? std::string("loaded") : model.error().message;
  }

 private:
  std::filesystem::path folder_;
};
using ModelFileFault = ModelFile;
using ModelFileProperty = ModelFile;

bool same(const ColorModel& a, const ColorModel& b) {
  if (a.samples.size() != b.samples.size()) return false;
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    if (a.samples[i].yuyv != b.samples[i].yuyv || !(a.samples[i].window == b.samples[i].window)) return false;
    if (a.samples[i].light.g != b.samples[i].light.g || a.samples[i].scale_y != b.samples[i].scale_y) return false;
  }
  return a.bins == b.bins && a.lights.size() == b.lights.size() && a.lights.back().r == b.lights.back().r &&
         a.object == b.object && a.surroundings == b.surroundings && a.width_px == b.width_px &&
         a.object_box == b.object_box && a.image_height_px == b.image_height_px &&
         a.distinctiveness == b.distinctiveness;
}

TEST_F(ModelFile, ComesBackAsItWentIn) {
  const ColorModel model = flag_model();
  ASSERT_TRUE(save_model(model, path()));
  const auto loaded = load_model(path());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(same(*loaded, model));
  EXPECT_FALSE(std::filesystem::exists(path() + ".part"));
}

TEST_F(ModelFile, WithoutSurroundingsToo) {
  ColorModel model = flag_model();
  model.surroundings.clear();
  ASSERT_TRUE(save_model(model, path()));
  const auto loaded = load_model(path());
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(loaded->surroundings.empty());
}

TEST_F(ModelFileFault, AMissingOneAndAFolder) {
  EXPECT_THAT(refusal(), HasSubstr("cannot be opened: No such file"));
  std::filesystem::create_directory(path());
  EXPECT_THAT(refusal(), HasSubstr(path()));
}

TEST_F(ModelFileFault, AnEmptyOneAndStrangers) {
  write({});
  EXPECT_THAT(refusal(), HasSubstr("empty"));
  write({'n', 'o', ' ', 'm', 'o', 'd', 'e', 'l'});
  EXPECT_THAT(refusal(), HasSubstr("not a colour model"));
  write(nlohmann::json::to_cbor({{"format", "something else"}, {"version", 1}}));
  EXPECT_THAT(refusal(), HasSubstr("not a colour model"));
  write(nlohmann::json::to_cbor(nlohmann::json::array({1, 2, 3})));
  EXPECT_THAT(refusal(), HasSubstr("not a colour model"));
}

TEST_F(ModelFileFault, ANewerOne) {
  ASSERT_TRUE(save_model(flag_model(), path()));
  auto envelope = nlohmann::json::from_cbor(read());
  envelope["version"] = kModelVersion + 1;
  write(nlohmann::json::to_cbor(envelope));
  EXPECT_THAT(refusal(), HasSubstr("version 2, this program reads up to 1"));
}

TEST_F(ModelFileFault, ATruncatedOneWhereverItEnds) {
  ASSERT_TRUE(save_model(flag_model(), path()));
  const Bytes whole = read();
  for (std::size_t size = 0; size < whole.size(); size += 1 + whole.size() / 200) {
    write(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    ASSERT_NE(refusal(), "loaded") << size;
  }
}

// Of lists, and of text in chunks of chunks: a parser that recurses would exhaust its stack.
TEST_F(ModelFileFault, ADeeplyNestedOne) {
  for (const int head : {0x9F, 0x7F, 0x5F}) {
    write(Bytes(4U << 20, static_cast<std::uint8_t>(head)));
    EXPECT_THAT(refusal(), AllOf(HasSubstr(path()),
                                 HasSubstr("offset 16: an item that holds others is 17 deep, expected at most 16")));
  }
  const Bytes payload(4U << 20, 0x9F);
  Bytes digest(SHA256_DIGEST_LENGTH);
  SHA256(payload.data(), payload.size(), digest.data());
  using nlohmann::json;
  write(json::to_cbor({{"format", "cgsr colour model"},
                       {"version", kModelVersion},
                       {"sha256", json::binary(digest)},
                       {"payload", json::binary(payload)}}));
  EXPECT_THAT(refusal(), HasSubstr("payload, offset 16: "));
}

TEST_F(ModelFileFault, ATooLargeOne) {
  write(Bytes((16U << 20) + 1, 0));
  EXPECT_THAT(refusal(), HasSubstr("larger than any colour model"));
}

// One byte of the payload changed: the checksum sees every one of them.
TEST_F(ModelFileProperty, NoDamagedByteGoesUnseen) {
  ASSERT_TRUE(save_model(flag_model(), path()));
  const Bytes whole = read();
  std::mt19937 random(31);
  for (int trial = 0; trial < 300; ++trial) {
    Bytes damaged = whole;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    write(damaged);
    const auto loaded = load_model(path());
    ASSERT_FALSE(loaded) << trial;
  }
}

// A payload that lies although its checksum is right: every size and number is looked at.
TEST_F(ModelFileFault, ALyingOne) {
  ASSERT_TRUE(save_model(flag_model(), path()));
  ColorModel wrong = flag_model();
  EXPECT_EQ(defect_of(wrong), "");

  const auto refused = [&](const std::function<void(ColorModel&)>& change) {
    ColorModel model = flag_model();
    change(model);
    EXPECT_FALSE(save_model(model, path("wrong.model")));
    return defect_of(model);
  };
  EXPECT_THAT(refused([](ColorModel& m) { m.object.pop_back(); }), HasSubstr("object has"));
  EXPECT_THAT(refused([](ColorModel& m) { m.object[0] = static_cast<std::uint16_t>(m.object[0] + 1); }),
              HasSubstr("sums to"));
  EXPECT_THAT(refused([](ColorModel& m) { m.surroundings.resize(7); }), HasSubstr("surroundings has"));
  EXPECT_THAT(refused([](ColorModel& m) { m.lights.clear(); }), HasSubstr("lights"));
  EXPECT_THAT(refused([](ColorModel& m) { m.lights[3].g = std::nan(""); }), HasSubstr("light"));
  EXPECT_THAT(refused([](ColorModel& m) { m.lights[3].g = 0.0; }), HasSubstr("light"));
  EXPECT_THAT(refused([](ColorModel& m) { m.width_px = std::nan(""); }), HasSubstr("window"));
  EXPECT_THAT(refused([](ColorModel& m) { m.height_px = 1e9; }), HasSubstr("window"));
  EXPECT_THAT(refused([](ColorModel& m) { m.object_box.width = -1; }), HasSubstr("object box"));
  EXPECT_THAT(refused([](ColorModel& m) { m.distinctiveness = std::nan(""); }), HasSubstr("distinctiveness"));
  EXPECT_THAT(refused([](ColorModel& m) { m.samples[0].width_px += 2; }), HasSubstr("patch"));
  EXPECT_THAT(refused([](ColorModel& m) { m.samples[0].scale_x = std::nan(""); }), HasSubstr("patch"));
  EXPECT_THAT(refused([](ColorModel& m) { m.samples.resize(kMaxSamples + 1, m.samples[0]); }), HasSubstr("samples"));
  EXPECT_THAT(refused([](ColorModel& m) { m.bins.per_channel = 17; }), HasSubstr("bins"));
}

TEST_F(ModelFileFault, AnUnwritablePlace) {
  const auto saved = save_model(flag_model(), path("no/such/folder/object.model"));
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().message, HasSubstr("cannot be written: No such file or directory"));
}

}  // namespace
}  // namespace cgsr::color
