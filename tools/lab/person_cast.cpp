#include "tools/lab/person_cast.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "hal/sim/people/identity.h"
#include "tools/lab/child.h"
#include "tools/lab/source_path.h"

namespace cgsr::lab {
namespace {

constexpr int kPortraits = 4;

}  // namespace

Result<std::string> empty_arena() {
  const std::string path = source_path("config/worlds/people.toml");
  std::ifstream in(path);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const auto people = text.find("[[person]]");
  if (people == std::string::npos) return fail(fmt::format("{}: has no [[person]]", path));
  text.resize(people);
  return text;
}

std::vector<int> draw_people(std::size_t count, Random& random) {
  std::vector<int> people;
  while (people.size() < count) {
    const int number = sim::kIdentities + random.below(sim::kLastIdentity - sim::kIdentities + 1);
    if (std::ranges::find(people, number) == people.end()) people.push_back(number);
  }
  return people;
}

int draw_dark_person(Random& random) {
  constexpr float kDark = 0.14F;  // albedo; the darkest by hand has .135
  int number = 0;
  do {
    number = draw_people(1, random).front();
  } while (sim::identity(number).skin.mean() > kDark);
  return number;
}

Result<std::filesystem::path> Portraits::of(int identity) {
  const auto pictures = folder_ / fmt::format("portraits-{}", identity);
  if (std::filesystem::exists(pictures)) return pictures;
  ++people_;
  return take(identity, 0);
}

Result<std::filesystem::path> Portraits::more_of(int identity) {
  ++again_;
  return take(identity, kPortraits);
}

Result<std::filesystem::path> Portraits::take(int identity, int first) {
  const auto pictures = folder_ / fmt::format("portraits-{}", identity);
  auto world = empty_arena();
  if (!world) return tl::unexpected(world.error());
  *world += fmt::format(
      "[[person]]\nname = \"sitter\"\nidentity = {}\nwalk = {{ stop = [{{ at_m = [2.4, 0.0, 0.0], heading_deg = 180.0 "
      "}}] "
      "}}\nhead = [{{ at_s = 0.0 }}, {{ at_s = 1.0, yaw_deg = 12.0 }}, {{ at_s = 2.0, yaw_deg = -12.0 }}, "
      "{{ at_s = 2.7, yaw_deg = -12.0 }}, {{ at_s = 6.0, yaw_deg = 8.0 }}]\n",
      identity);
  const auto file = folder_ / fmt::format("sitter-{}.toml", identity);
  if (auto written = write_text(file, *world); !written) return tl::unexpected(written.error());
  std::filesystem::create_directories(pictures);
  for (int i = first; i < first + kPortraits; ++i) {
    auto taken = run_cgsr({"sim", "render", "--world", file.string(), "--time", fmt::format("{}", 0.5 + 0.7 * i),
                           "--from", "1.2,0.05,1.55", "--to", "2.4,0,1.55", "--size", "640x480", "--seed",
                           fmt::format("{}", i + 1), "--output", (pictures / fmt::format("{}.png", i)).string()});
    if (!taken) return tl::unexpected(taken.error());
  }
  return pictures;
}

Row photographed_again(const Portraits& portraits) {
  return share_row("enrolment", "photographed again, for fewer than two faces were found in four pictures",
                   portraits.again(), portraits.people());
}

Result<int> enroll_all(const std::vector<int>& identities, Portraits& portraits, const std::filesystem::path& file) {
  int refused = 0;
  for (const int identity : identities) {
    const auto pictures = portraits.of(identity);
    if (!pictures) return tl::unexpected(pictures.error());
    std::vector<std::string> words{"people",      "enroll",          "--identities",
                                   file.string(), "--name",          fmt::format("identity {}", identity),
                                   "--input",     pictures->string()};
    auto enrolled = run_cgsr(words);
    if (!enrolled && enrolled.error().message.find("with exactly one face") != std::string::npos) {
      // Whoever enrols takes more pictures.
      if (const auto more = portraits.more_of(identity); !more) return tl::unexpected(more.error());
      enrolled = run_cgsr(words);
    }
    if (enrolled && enrolled->find("has a single view") != std::string::npos) {
      if (const auto more = portraits.more_of(identity); !more) return tl::unexpected(more.error());
      words.emplace_back("--more");
      enrolled = run_cgsr(words);
    }
    if (enrolled) continue;
    ++refused;
    words.emplace_back("--alike");
    enrolled = run_cgsr(words);
    if (!enrolled) return tl::unexpected(enrolled.error());
  }
  return refused;
}

Result<nlohmann::json> run_with_people(const TableFolder& folder, const std::string& shipped, std::uint64_t seed,
                                       const std::vector<std::string>& more) {
  const auto robot = folder / "robot.toml";
  const bool own_scenario = std::filesystem::exists(folder / "scenario.toml");
  const auto written = write_text(robot, fmt::format("extends = \"{}\"\nperson.identities = \"identities\"\n{}",
                                                     std::filesystem::absolute(shipped).string(),
                                                     own_scenario ? "sim.scenario = \"scenario.toml\"\n" : ""));
  if (!written) return tl::unexpected(written.error());
  std::vector<std::string> words{"--force"};
  words.insert(words.end(), more.begin(), more.end());
  return run_robot(robot, seed, words);
}

}  // namespace cgsr::lab
