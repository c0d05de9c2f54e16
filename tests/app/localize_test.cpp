// cgsr localize on images that others made.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace cgsr::app::testing {
namespace {

// A cube on a table: the map knows nothing of what fills most of the image. The camera and the first pose are those that came with it.
TEST(LocalizeCommand, FollowsTheRecordedCube) {
  const char* data = std::getenv("CGSR_DATA");
  if (data == nullptr) {
    const char* require = std::getenv("CGSR_REQUIRE_DATA");
    if (require != nullptr && std::string(require) == "1") FAIL() << "CGSR_DATA is not set";
    GTEST_SKIP() << "SKIPPED: no data";
  }
  const std::filesystem::path folder = std::filesystem::path(data) / "localization" / "cube";
  ASSERT_TRUE(std::filesystem::exists(folder)) << "CGSR_DATA does not lead to localization/cube";
  const ScratchFolder scratch;
  write_text(scratch / "camera.yaml",
             "image_width: 640\nimage_height: 480\ncamera_name: cube\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
             "  data: [547.7367575, 0.0, 338.7036994, 0.0, 542.0744058, 234.5083345, 0.0, 0.0, 1.0]\n"
             "distortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.0, 0.0, 0.0, "
             "0.0, 0.0]\n");
  write_text(scratch / "pose.csv",
             "tx,ty,tz,qw,qx,qy,qz\n"
             "0.22309615,-0.18366902,0.43085227,0.34542029,-0.80912113,-0.44175978,0.17565913\n");
  const Outcome run =
      run_cgsr({"localize", "--map", (folder / "cube.cao").string(), "--camera", scratch / "camera.yaml", "--input",
                (folder / "img").string(), "--pose", scratch / "pose.csv", "--config",
                CGSR_SOURCE_DIR "/config/localization/free.toml", "--json", scratch / "sum.json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto sum = nlohmann::json::parse(read_text(scratch / "sum.json"));
  EXPECT_EQ(sum.at("images"), 110);
  EXPECT_GE(sum.at("corrected").get<int>(), 105);
}

}  // namespace
}  // namespace cgsr::app::testing
