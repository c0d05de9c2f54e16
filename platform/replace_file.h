#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

#include "platform/error.h"

namespace cgsr {

/// Writes a whole file so that a reader meets either what was there before or all of the new content, after a power cut too.
///
/// The content goes into a new file of a name of its own in the same folder; that file is synchronised (fsync), renamed over `path`, and
/// the folder is synchronised. It keeps the permissions of the file that it replaces. A symbolic link stays a link and what it points to is
/// written in place, as is everything that is no regular file (a device, a pipe): renaming would put a file where the link or device was.
///
/// Allocates and waits for the disk: not for the frame path.
/// \param parts  the content, piece after piece.
/// \return what could not be written, with the path and the system's reason. The old content is then still there (in place: it may not be).
Result<void> replace_file(const std::filesystem::path& path, std::initializer_list<std::string_view> parts);

/// Takes a file away so that a power cut does not bring it back: the name is removed and its folder synchronised. A symbolic link stays, what it
/// points to goes; a device or a pipe stays. A file that is not there is no error. Ours.
/// \return what speaks against it, with the path and the system's reason.
Result<void> remove_file(const std::filesystem::path& path);

/// Tests that replace_file() or opening `path` for writing can succeed, and leaves everything as it was: content, times, and no file where
/// there was none.
/// \return what speaks against it: a folder of that name, a folder that is missing or may not be written, a read-only file system.
Result<void> check_writable(const std::filesystem::path& path);

}  // namespace cgsr
