#include "platform/replace_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace cgsr {
namespace {

/// An open file descriptor, or none.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] bool open() const { return number_ >= 0; }
  [[nodiscard]] int number() const { return number_; }
  /// \return whether all that was written reached the file system: some report a full disk here only.
  [[nodiscard]] bool close() { return ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

tl::unexpected<Error> refused(const std::filesystem::path& path, std::string_view what) {
  return fail(fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno)));
}

bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// \return whether all parts are on the disk. A device or a pipe has none: that it cannot be synchronised is no error.
bool write_and_sync(Descriptor& file, std::initializer_list<std::string_view> parts) {
  for (const std::string_view part : parts) {
    if (!write_all(file.number(), part)) return false;
  }
  if (::fsync(file.number()) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP) return false;
  return file.close();
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

/// A name in the same folder that no other file has: `NAME.XXXXXX`.
std::string name_beside(const std::filesystem::path& path) {
  return path.string() + ".XXXXXX";
}

/// A symbolic link, a device, a pipe or a socket: nothing may be renamed over it.
bool is_written_through(const std::filesystem::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

Result<void> write_through(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (!file.open() || !write_and_sync(file, parts)) return refused(path, "cannot be written");
  return {};
}

/// Some file systems refuse it for a folder: then the last change of a name is as durable as they make it.
void sync_folder_of(const std::filesystem::path& path) {
  const Descriptor folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.open()) ::fsync(folder.number());
}

/// The permissions of the file at `path`, or those that a new file gets.
mode_t permissions_for(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return status.st_mode & 0777U;
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666U & ~mask;
}

}  // namespace

Result<void> replace_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
  if (is_written_through(path)) return write_through(path, parts);
  std::string beside = name_beside(path);
  Descriptor file(::mkostemp(beside.data(), O_CLOEXEC));
  if (!file.open()) return refused(path, "cannot be written");
  if (::fchmod(file.number(), permissions_for(path)) != 0 || !write_and_sync(file, parts)) {
    const auto why = refused(path, "cannot be written");
    ::unlink(beside.c_str());
    return why;
  }
  if (::rename(beside.c_str(), path.c_str()) != 0) {
    const auto why = refused(path, "cannot be put in place");
    ::unlink(beside.c_str());
    return why;
  }
  sync_folder_of(path);  // the file is whole either way
  return {};
}

Result<void> remove_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto target = std::filesystem::canonical(path, error);
  if (error == std::errc::no_such_file_or_directory) return {};
  const bool is_regular = !error && std::filesystem::is_regular_file(target, error);
  if (error) return fail(fmt::format("{}: cannot be taken away: {}", path.string(), error.message()));
  if (!is_regular) return {};
  if (::unlink(target.c_str()) != 0) return refused(path, "cannot be taken away");
  sync_folder_of(target);
  return {};
}

Result<void> check_writable(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode))
      return fail(fmt::format("{}: is a folder: expected the name of a file", path.string()));
    // Opening a pipe would wait for its reader; opening anything else for writing alone changes nothing.
    const bool writable = S_ISREG(status.st_mode) ? Descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC)).open()
                                                  : ::access(path.c_str(), W_OK) == 0;
    if (!writable) return refused(path, "cannot be written");
    if (is_written_through(path)) return {};
  } else if (is_written_through(path)) {  // a link to what is not there yet
    const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
    if (!file.open()) return refused(path, "cannot be written");
    std::error_code error;
    const auto made = std::filesystem::read_symlink(fmt::format("/proc/self/fd/{}", file.number()), error);
    if (!error) std::filesystem::remove(made, error);
    return {};
  }
  std::string beside = name_beside(path);
  const Descriptor file(::mkostemp(beside.data(), O_CLOEXEC));
  if (!file.open()) return refused(path, "cannot be written");
  ::unlink(beside.c_str());
  return {};
}

}  // namespace cgsr
