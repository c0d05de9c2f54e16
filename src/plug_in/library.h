#pragma once

#include <string>

#include "platform/error.h"

namespace cgsr {

/// A shared library that the program loads when a file asks for it, and never links.
class PlugInLibrary {
 public:
  /// \param path  of the library.  \return what the loader says when it cannot be loaded.
  static Result<PlugInLibrary> open(const std::string& path);

  /// \return where a library of that file name lies beside the program.
  static Result<std::string> beside_program(const std::string& file_name);

  /// \return a function of the library; null when it has none of that name.
  template <class Function>
  [[nodiscard]] Function* function(const char* name) const {
    return reinterpret_cast<Function*>(symbol(name));
  }

 private:
  explicit PlugInLibrary(void* handle) : handle_(handle) {}
  [[nodiscard]] void* symbol(const char* name) const;

  void* handle_;  ///< never closed: threads of the library would lose the ground under their feet.
};

}  // namespace cgsr
