#include "pipeline/illumination/luma_view.h"

#include <array>
#include <cstdint>

#include <gtest/gtest.h>

namespace cgsr::illumination {
namespace {

bool is_clipped(std::array<std::uint8_t, 16> yuyv) {
  const LumaView view(ImageView{yuyv.data(), 4, 2, 8, PixelFormat::kYuyv});
  return view.is_clipped(1.5, 0.5, view.at(1.5F, 0.5F));
}

// Of white light 210 is far from too much; of light as warm as a filament's its red is.
TEST(LumaView, OneColorThatHoldsNoMoreIsEnough) {
  std::array<std::uint8_t, 16> grey;
  std::array<std::uint8_t, 16> warm;
  for (std::size_t i = 0; i < grey.size(); i += 4) {
    for (const std::size_t luma : {i, i + 2}) grey[luma] = warm[luma] = 210;
    grey[i + 1] = grey[i + 3] = 128;
    warm[i + 1] = 100;
    warm[i + 3] = 150;
  }
  EXPECT_FALSE(is_clipped(grey));
  EXPECT_TRUE(is_clipped(warm));

  auto one_neighbour = grey;
  one_neighbour[4 + 8] = 235;  // (2, 1)
  EXPECT_TRUE(is_clipped(one_neighbour));
  auto beside_them = grey;
  beside_them[0] = beside_them[6] = 235;  // (0, 0) and (3, 0)
  EXPECT_FALSE(is_clipped(beside_them));
}

TEST(LumaView, AGreyImageHoldsAllButItsLastLevels) {
  for (const int level : {250, 253, 254, 255}) {
    std::array<std::uint8_t, 4> grey;
    grey.fill(static_cast<std::uint8_t>(level));
    const LumaView view(ImageView{grey.data(), 2, 2, 2, PixelFormat::kGrey8});
    EXPECT_EQ(view.is_clipped(0.4, 0.4, view.at(0.4F, 0.4F)), level >= 254) << level;
  }
}

// A place that is dark although a neighbour is clipped lies in the shadow, and tells where that begins.
TEST(LumaView, ADarkPlaceBesideAClippedOneTells) {
  std::array<std::uint8_t, 4> grey{60, 255, 60, 255};
  const LumaView view(ImageView{grey.data(), 2, 2, 2, PixelFormat::kGrey8});
  EXPECT_FALSE(view.is_clipped(0.2, 0.5, view.at(0.2F, 0.5F)));
  EXPECT_TRUE(view.is_clipped(0.8, 0.5, view.at(0.8F, 0.5F)));
}

}  // namespace
}  // namespace cgsr::illumination
