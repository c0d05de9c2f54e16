#include "tools/lab/person_watch.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <fmt/format.h>

#include "tools/lab/csv_row.h"

namespace cgsr::lab {
namespace {

Result<std::vector<Seen>> read_csv(const std::filesystem::path& file, double begins_s) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const auto names = csv_cells(line);
  const auto column = [&names](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
  };
  const std::size_t time = column("stamp_s"), number = column("person_number"), by = column("person_by"),
                    faces = column("faces"), state = column("person");
  const std::size_t last = std::max({time, number, by, faces, state});
  if (last >= names.size()) return fail(fmt::format("{}: has no column person_number or faces", file.string()));
  std::vector<Seen> seen;
  while (std::getline(in, line)) {
    const auto cells = csv_cells(line);
    if (cells.size() <= last) return fail(fmt::format("{}: a row has {} columns", file.string(), cells.size()));
    seen.push_back({std::stod(cells[time]) - begins_s, cells[number].empty() ? -1 : std::stoi(cells[number]),
                    cells[by] == "face", !cells[faces].empty() && cells[faces] != "0", cells[state] == "unsure"});
  }
  return seen;
}

}  // namespace

Result<std::vector<Seen>> watch(const TableFolder& folder, const std::string& shipped, std::uint64_t seed,
                                const std::string& more, double begins_s) {
  const auto robot = folder / "robot.toml";
  std::ofstream(robot) << fmt::format(
      "extends = \"{}\"\nsim.scenario = \"scenario.toml\"\nperson.identities = \"identities\"\ntask.person.number = "
      "1\n{}",
      std::filesystem::absolute(shipped).string(), more);
  const auto csv = folder / "run.csv";
  auto run = run_cgsr({"run", "--config", robot.string(), "--seed", std::to_string(seed), "--log-level", "warning",
                       "--csv", csv.string(), "--force"});
  if (!run) return tl::unexpected(run.error());
  return read_csv(csv, begins_s);
}

SharedImages::SharedImages(const TableFolder& folder) : cache_(folder / "images") {
  if (const char* cache = std::getenv("XDG_CACHE_HOME")) before_ = cache;
  setenv("XDG_CACHE_HOME", cache_.c_str(), 1);
  setenv("CGSR_SIM_IMAGES", "record", 1);
}

SharedImages::~SharedImages() {
  unsetenv("CGSR_SIM_IMAGES");
  before_ ? setenv("XDG_CACHE_HOME", before_->c_str(), 1) : unsetenv("XDG_CACHE_HOME");
  std::error_code ignored;
  std::filesystem::remove_all(cache_, ignored);
}

std::array<double, 3> draw_vivid_shirt(Random& random) {
  std::array<double, 3> shirt{};
  for (double& channel : shirt) channel = random.uniform(0.1, 0.9);
  const auto low = static_cast<std::size_t>(random.below(3));
  shirt[low] = random.uniform(0.05, 0.2);
  shirt[(low + 1) % 3] = random.uniform(0.5, 0.9);
  return shirt;
}

}  // namespace cgsr::lab
