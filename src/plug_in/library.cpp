#include "src/plug_in/library.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

namespace cgsr {

Result<PlugInLibrary> PlugInLibrary::open(const std::string& path) {
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (handle != nullptr) return PlugInLibrary(handle);
  const char* words = dlerror();
  return fail(words == nullptr ? "no reason given" : words);
}

Result<std::string> PlugInLibrary::beside_program(const std::string& file_name) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return fail(fmt::format("where the program lies cannot be found out: {}", error.message()));
  return (program.parent_path() / file_name).string();
}

void* PlugInLibrary::symbol(const char* name) const {
  return dlsym(handle_, name);
}

}  // namespace cgsr
