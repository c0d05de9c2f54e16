#include "src/input/identities_file.h"

#include <fcntl.h>
#include <openssl/sha.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "platform/cbor_depth.h"

namespace cgsr::app {
namespace {

using nlohmann::json;
using person::FaceView;
using person::Identities;
using person::Identity;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kFormat = "cgsr identities";
constexpr std::uintmax_t kLargestFile = std::uintmax_t{1} << 30U;  // 1,000 people with 50 views are 520 MB
constexpr std::size_t kMaxNameBytes = 200;

Bytes sha256_of(const Bytes& bytes) {
  Bytes digest(SHA256_DIGEST_LENGTH);
  SHA256(bytes.data(), bytes.size(), digest.data());
  return digest;
}

json json_of(const Identities& identities) {
  json people = json::array();
  for (const Identity& one : identities.people) {
    json views = json::array();
    for (const FaceView& view : one.views) views.push_back(json::binary(Bytes(view.begin(), view.end())));
    people.push_back({{"number", one.number}, {"name", one.name}, {"views", std::move(views)}});
  }
  return {{"next_number", identities.next_number}, {"people", std::move(people)}};
}

// \throws where a value is missing, of another type or out of its range.
Identities identities_of(const json& j) {
  Identities identities;
  j.at("next_number").get_to(identities.next_number);
  std::set<person::Label> numbers;
  for (const json& person : j.at("people")) {
    Identity& one = identities.people.emplace_back();
    person.at("number").get_to(one.number);
    person.at("name").get_to(one.name);
    if (one.number < 1 || one.number >= identities.next_number || !numbers.insert(one.number).second)
      throw std::out_of_range("a number that nobody was given");
    if (one.name.empty() || one.name.size() > kMaxNameBytes) throw std::out_of_range("a name of no sensible length");
    for (const json& stored : person.at("views")) {
      const Bytes& bytes = stored.get_binary();
      FaceView& view = one.views.emplace_back();
      if (bytes.size() != view.size()) throw std::out_of_range("a view of another size");
      std::copy(bytes.begin(), bytes.end(), view.begin());
    }
  }
  return identities;
}

/// Why a file was not read, and whether its contents are to blame.
struct ReadFailure {
  Error error;
  bool damaged = false;
};

tl::unexpected<ReadFailure> unreadable(const std::filesystem::path& path, const std::string& why) {
  return tl::unexpected(ReadFailure{{fmt::format("{}: {}", path.string(), why)}, false});
}

tl::unexpected<ReadFailure> damaged(const std::filesystem::path& path, const std::string& why) {
  return tl::unexpected(ReadFailure{{fmt::format("{}: damaged, or no identities file: {}", path.string(), why)}, true});
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

bool write_all(int file, const Bytes& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t wrote = ::write(file, bytes.data() + done, bytes.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return ::fsync(file) == 0;
}

bool write_privately(const std::filesystem::path& path, const Bytes& bytes) {
  ::unlink(path.c_str());  // what a killed run left there
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  return file.number() >= 0 && write_all(file.number(), bytes);
}

tl::expected<Identities, ReadFailure> read_identities(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error == std::errc::no_such_file_or_directory) return Identities{};
  if (error) return unreadable(path, "cannot be read: " + error.message());
  if (size > kLargestFile) return damaged(path, "it is larger than any");
  std::ifstream in(path, std::ios::binary);
  const Bytes bytes(std::istreambuf_iterator<char>(in), {});
  if (bytes.size() != size) return unreadable(path, "cannot be read");
  if (const auto problem = cbor_depth_problem(bytes)) return damaged(path, *problem);
  try {
    const json file = json::from_cbor(bytes);
    if (!file.is_object() || file.value("format", "") != kFormat) return damaged(path, "it is something else");
    if (const int version = file.at("version").get<int>(); version > kIdentitiesVersion) {
      return unreadable(path, fmt::format("version {} is newer than this program's {}", version, kIdentitiesVersion));
    }
    const Bytes& payload = file.at("payload").get_binary();
    const Bytes& checksum = file.at("sha256").get_binary();
    if (sha256_of(payload) != checksum) return damaged(path, "its checksum does not fit");
    if (const auto problem = cbor_depth_problem(payload)) return damaged(path, "payload, " + *problem);
    return identities_of(json::from_cbor(payload));
  } catch (const std::exception& wrong) {
    return damaged(path, wrong.what());
  }
}

}  // namespace

Result<void> save_identities(const Identities& identities, const std::filesystem::path& path) {
  const Bytes payload = json::to_cbor(json_of(identities));
  const Bytes bytes = json::to_cbor(json{{"format", kFormat},
                                         {"version", kIdentitiesVersion},
                                         {"sha256", json::binary(sha256_of(payload))},
                                         {"payload", json::binary(payload)}});
  auto beside = path;
  beside += ".part";
  errno = 0;
  if (!write_privately(beside, bytes) || std::rename(beside.c_str(), path.c_str()) != 0) {
    const std::string why = errno != 0 ? std::strerror(errno) : "unknown cause";
    ::unlink(beside.c_str());
    return fail(fmt::format("{}: cannot be written: {}", path.string(), why));
  }
  return {};
}

Result<Identities> load_identities(const std::filesystem::path& path) {
  auto read = read_identities(path);
  if (!read) return tl::unexpected(read.error().error);
  return std::move(*read);
}

Result<OpenedIdentities> open_identities(const std::filesystem::path& path) {
  auto read = read_identities(path);
  if (read) return OpenedIdentities{std::move(*read), {}};
  const std::string& message = read.error().error.message;
  if (!read.error().damaged) return fail(message);
  for (int number = 1;; ++number) {
    auto aside = path;
    aside += fmt::format(".damaged-{}", number);
    if (std::filesystem::exists(aside)) continue;
    std::error_code error;
    std::filesystem::rename(path, aside, error);
    if (error) return fail(fmt::format("{}; it cannot be put aside: {}", message, error.message()));
    return OpenedIdentities{{}, fmt::format("{}; kept as {}", message, aside.string())};
  }
}

}  // namespace cgsr::app
