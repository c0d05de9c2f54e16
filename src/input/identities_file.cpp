#include "src/input/identities_file.h"

#include <fcntl.h>
#include <openssl/sha.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <thread>
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
  return tl::unexpected(ReadFailure{{fmt::format("{}: damaged: {}", path.string(), why)}, true});
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

// The format's name is the first text of the file. What is cut off or changed behind it is damaged, an empty file is what a full disk left; anything else is
// somebody else's.
bool is_ours(const Bytes& bytes) {
  constexpr std::ptrdiff_t kHead = 64;
  const auto end = bytes.begin() + std::min(kHead, static_cast<std::ptrdiff_t>(bytes.size()));
  const std::string_view format = kFormat;
  return bytes.empty() || std::search(bytes.begin(), end, format.begin(), format.end()) != end;
}

tl::expected<Identities, ReadFailure> read_identities(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error == std::errc::no_such_file_or_directory) return Identities{};
  if (error) return unreadable(path, "cannot be read: " + error.message());
  if (size > kLargestFile) return unreadable(path, "no identities file: it is larger than any");
  std::ifstream in(path, std::ios::binary);
  const Bytes bytes(std::istreambuf_iterator<char>(in), {});
  if (bytes.size() != size) return unreadable(path, "cannot be read");
  if (!is_ours(bytes)) return unreadable(path, "no identities file: it is something else");
  if (const auto problem = cbor_depth_problem(bytes)) return damaged(path, *problem);
  try {
    const json file = json::from_cbor(bytes);
    if (!file.is_object() || file.value("format", "") != kFormat) return damaged(path, "its first entry is no format");
    const int version = file.at("version").get<int>();
    if (version > kIdentitiesVersion) {
      return unreadable(path, fmt::format("version {} is newer than this program's {}", version, kIdentitiesVersion));
    }
    if (version < kIdentitiesVersion) {
      return unreadable(path, fmt::format("version {} is older than this program's {}: faces are described otherwise "
                                          "since; remove the file and enrol its people again",
                                          version, kIdentitiesVersion));
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

/// What a symbolic link points to; the path itself where it is none.
std::filesystem::path target_of(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  auto target = std::filesystem::weakly_canonical(path, error);
  return error ? path : target;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::filesystem::path damaged_name(std::filesystem::path path, int number) {
  path += fmt::format(".damaged-{}", number);
  return path;
}

Result<std::filesystem::path> put_aside(const std::filesystem::path& path) {
  std::error_code error;
  int number = 1;
  while (std::filesystem::exists(damaged_name(path, number), error)) ++number;
  auto aside = damaged_name(path, number);
  std::filesystem::rename(path, aside, error);
  if (error) return fail(error.message());
  using std::filesystem::perms;
  std::filesystem::permissions(aside, perms::owner_read | perms::owner_write, error);
  return aside;
}

}  // namespace

std::optional<std::string> name_problem(std::string_view name) {
  if (name.empty()) return "the name is empty";
  if (name.size() > kMaxNameBytes)
    return fmt::format("the name has {} bytes, expected at most {}", name.size(), kMaxNameBytes);
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::ranges::any_of(name, is_control)) return "the name has control characters";
  return std::nullopt;
}

Result<void> save_identities(const Identities& identities, const std::filesystem::path& path) {
  for (const Identity& one : identities.people)
    if (const auto problem = name_problem(one.name)) return fail(fmt::format("{}: {}", path.string(), *problem));
  const auto target = target_of(path);
  const Bytes payload = json::to_cbor(json_of(identities));
  const Bytes bytes = json::to_cbor(json{{"format", kFormat},
                                         {"version", kIdentitiesVersion},
                                         {"sha256", json::binary(sha256_of(payload))},
                                         {"payload", json::binary(payload)}});
  auto beside = target;
  beside += ".part";
  errno = 0;
  if (!write_privately(beside, bytes) || std::rename(beside.c_str(), target.c_str()) != 0) {
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

/// Of the folder: the file itself gives way to a new one when it is written.
class IdentitiesEdit::FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {}

  [[nodiscard]] bool is_open() const { return folder_.number() >= 0; }
  [[nodiscard]] Result<void> wait() const {
    constexpr int kTries = 100;
    constexpr std::chrono::milliseconds kPause{100};
    for (int i = 0; i < kTries; ++i) {
      if (::flock(folder_.number(), LOCK_EX | LOCK_NB) == 0) return {};
      if (errno != EWOULDBLOCK && errno != EINTR) return fail(std::strerror(errno));
      std::this_thread::sleep_for(kPause);
    }
    return fail("another cgsr people has been changing it for 10 s");
  }

 private:
  Descriptor folder_;
};

IdentitiesEdit::IdentitiesEdit(std::filesystem::path path, Identities identities, std::string damage,
                               std::shared_ptr<const FolderLock> lock)
    : path_(std::move(path)), identities_(std::move(identities)), damage_(std::move(damage)), lock_(std::move(lock)) {}

Result<IdentitiesEdit> IdentitiesEdit::open(const std::filesystem::path& path) {
  const auto target = target_of(path);
  const auto lock = std::make_shared<const FolderLock>(folder_of(target));
  if (!lock->is_open())
    return fail(fmt::format("{}: its folder cannot be read: {}", path.string(), std::strerror(errno)));
  if (const auto locked = lock->wait(); !locked)
    return fail(fmt::format("{}: {}", path.string(), locked.error().message));
  auto read = read_identities(target);
  if (!read && !read.error().damaged) return tl::unexpected(read.error().error);
  std::string damage = read ? std::string() : read.error().error.message;
  return IdentitiesEdit(target, read ? std::move(*read) : Identities{}, std::move(damage), lock);
}

Result<std::string> IdentitiesEdit::save() {
  std::string note;
  if (!damage_.empty()) {
    const auto aside = put_aside(path_);
    if (!aside) return fail(fmt::format("{}; it cannot be put aside: {}", damage_, aside.error().message));
    note = fmt::format("{}; kept as {}", damage_, aside->string());
    damage_.clear();
  }
  if (auto saved = save_identities(identities_, path_); !saved)
    return fail(note.empty() ? saved.error().message : fmt::format("{}; {}", saved.error().message, note));
  return note;
}

std::vector<std::filesystem::path> kept_aside(const std::filesystem::path& path) {
  const auto target = target_of(path);
  const std::string prefix = target.filename().string() + ".damaged-";
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (std::filesystem::directory_iterator one(folder_of(target), error), end; !error && one != end;
       one.increment(error))
    if (one->path().filename().string().starts_with(prefix))
      found.push_back(target.parent_path() / one->path().filename());
  std::ranges::sort(found);
  return found;
}

}  // namespace cgsr::app
