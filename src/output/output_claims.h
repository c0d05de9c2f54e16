#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace cgsr::app {

/// What an existing file must be to be replaced without --force.
struct FileKind {
  std::string name;                            ///< for the message: "a CSV file with the columns frame,found,..."
  std::function<bool(std::string_view)> is{};  ///< whether a file that begins with these bytes (up to 64 KiB) is one.
  std::vector<std::string> endings{};          ///< that its name must have, in small letters; none: any.
};

/// A CSV file whose first line is `header`, or one is the beginning of the other: new columns are appended.
FileKind csv_file(std::string_view header);
FileKind json_object();
FileKind json_list();     ///< the rows of cgsr reproduce, a trace.
FileKind mcap_file();     ///< a recording.
FileKind video_file();    ///< Matroska, AVI or MP4.
FileKind picture_file();  ///< PNG, JPEG, BMP, TIFF, WebP or PNM.
FileKind compact_map();   ///< of cgsr map import.
FileKind color_model();   ///< of cgsr learn.
FileKind camera_yaml();   ///< as ROS writes it.
FileKind html_page();
/// A TOML file that has no other sections than these: what a user wrote beside them would be lost.
FileKind toml_with(std::vector<std::string> sections);
/// A file with exactly this text, or that begins with it: what was changed in it would be lost.
FileKind same_text(std::string text);
FileKind text_beginning(std::string text);

/// The files of one command. It names all that it reads and all that it writes, and claims the outputs before it reads the first image, so
/// that a mistyped option destroys nothing and what cannot be written is reported at once.
///
///     OutputClaims files(options.force);
///     files.reads(options.input, "--input");
///     files.writes(options.csv, "--csv", csv_file(kColumns));
///     if (auto claimed = files.claim(); !claimed) return report(claimed.error());
///
/// An output is refused that is an input or another output of the same command, by any name (links, hard links, ..), with --force too; that
/// exists and is neither empty nor of its kind, without --force; whose name has another ending; that cannot be written. Devices and pipes
/// are of any kind.
class OutputClaims {
 public:
  explicit OutputClaims(bool force) : force_(force) {}

  /// \param path  a file, or a folder whose images are read; empty: none. \param option  that names it, for the message.
  void reads(const std::filesystem::path& path, std::string option);
  void writes(const std::filesystem::path& path, std::string option, FileKind kind);

  /// \return the first output that is refused, with what to do. Nothing was changed on the disk.
  [[nodiscard]] Result<void> claim() const;

 private:
  struct Input {
    std::filesystem::path path;
    std::string option;
  };
  struct Output {
    std::filesystem::path path;
    std::string option;
    FileKind kind;
  };

  [[nodiscard]] Result<void> claim(std::size_t number) const;
  [[nodiscard]] static Result<void> check_ending(const Output& output);
  [[nodiscard]] Result<void> check_inputs(const Output& output) const;
  [[nodiscard]] Result<void> check_content(const Output& output) const;

  bool force_;
  std::vector<Input> inputs_;
  std::vector<Output> outputs_;
};

}  // namespace cgsr::app
