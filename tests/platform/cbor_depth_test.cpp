// Records that would exhaust the stack of a parser that recurses.
#include "platform/cbor_depth.h"

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace cgsr {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

/// `levels` heads, one in the other, and an item.
Bytes nested(const Bytes& head, std::size_t levels, const Bytes& innermost = {0x00}) {
  Bytes bytes;
  for (std::size_t i = 0; i < levels; ++i) bytes.insert(bytes.end(), head.begin(), head.end());
  bytes.insert(bytes.end(), innermost.begin(), innermost.end());
  return bytes;
}

TEST(CborDepth, EveryWayToNestIsBounded) {
  const std::vector<Bytes> heads{
      {0x81},                                                             // an array of one
      {0x9F},                                                             // an array until a break
      {0x98, 0x02},                                                       // an array of two
      {0xA1, 0x61, 'k'},                                                  // a map of one
      {0xBF, 0x61, 'k'},                                                  // a map until a break
      {0x7F},                                                             // text in chunks
      {0x5F},                                                             // bytes in chunks
      {0xC1},                                                             // a tag
      {0x9B, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},             // a length that a parser takes for none
      {0xBB, 0x80, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x61, 'k'},  // twice as many overflow
  };
  for (const Bytes& head : heads) {
    EXPECT_EQ(cbor_depth_problem(nested(head, kMaxCborDepth)), std::nullopt) << int{head[0]};
    const auto problem = cbor_depth_problem(nested(head, 1'000'000));
    ASSERT_TRUE(problem) << int{head[0]};
    EXPECT_EQ(*problem, "offset " + std::to_string(kMaxCborDepth * head.size()) +
                            ": an item that holds others is 17 deep, expected at most 16");
  }
}

TEST(CborDepth, ManyItemsBesideEachOtherAreNotDeep) {
  json wide = json::array();
  for (int i = 0; i < 1000; ++i)
    wide.push_back({{"a", json::array({1, 2.5, "text", json::binary({1, 2, 3})})}, {"b", {}}});
  EXPECT_EQ(cbor_depth_problem(json::to_cbor(wide)), std::nullopt);
  Bytes in_chunks = nested({0x9F}, 1, {});
  for (int i = 0; i < 1000; ++i) in_chunks.insert(in_chunks.end(), {0x7F, 0x61, 'a', 0x61, 'b', 0xFF});
  in_chunks.push_back(0xFF);
  EXPECT_EQ(cbor_depth_problem(in_chunks), std::nullopt);
}

/// How deep a parser goes into arrays and maps.
struct DepthOfParser final : json::json_sax_t {
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return down(); }
  bool key(string_t&) override { return true; }
  bool end_object() override { return --depth >= 0; }
  bool start_array(std::size_t) override { return down(); }
  bool end_array() override { return --depth >= 0; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }
  bool down() {
    deepest = std::max(deepest, ++depth);
    return true;
  }
  int depth = 0;
  int deepest = 0;
};

// Well-formed or not: what passes the walk does not take the parser deeper.
TEST(CborDepthProperty, NoParserGetsDeeperThanTheWalk) {
  std::mt19937 random(20261130);
  constexpr std::uint8_t kLikely[] = {0x81, 0x82, 0x9F, 0x9F, 0xA1, 0xBF, 0x61, 0x60,
                                      0x7F, 0xFF, 0x00, 0x98, 0x01, 0xC0, 0x5F};
  int refused = 0;
  int deep = 0;
  for (int trial = 0; trial < 50'000; ++trial) {
    Bytes bytes(random() % 120);
    for (auto& byte : bytes) {
      byte = random() % 8 == 0 ? static_cast<std::uint8_t>(random()) : kLikely[random() % std::size(kLikely)];
    }
    if (trial % 2 == 0) bytes.insert(bytes.begin(), random() % 20, 0x9F);
    if (cbor_depth_problem(bytes)) {
      ++refused;
      continue;
    }
    DepthOfParser parser;
    static_cast<void>(json::sax_parse(bytes, &parser, json::input_format_t::cbor));
    ASSERT_LE(parser.deepest, kMaxCborDepth) << trial;
    deep += parser.deepest > kMaxCborDepth / 2 ? 1 : 0;
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(deep, 1000);
}

}  // namespace
}  // namespace cgsr
