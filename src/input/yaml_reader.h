#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <string_view>
#include <vector>

#include "platform/error.h"

namespace cgsr::app {

/// Ours. Finds what it looks for in the mapping of a YAML file, and says where something is wrong: file, line, value and what was expected.
class YamlReader {
 public:
  /// \param root  a mapping; it and `name`, the file's, live on.
  YamlReader(const YAML::Node& root, std::string_view name) : root_(root), name_(name) {}

  [[nodiscard]] Error wrong(const YAML::Node& at, const std::string& words) const;
  [[nodiscard]] Error missing(std::string_view key, std::string_view expected) const;
  [[nodiscard]] Result<void> refuse_doubled_keys() const;

  /// \return a finite number. \param key  for the message.
  [[nodiscard]] Result<double> number(const YAML::Node& node, std::string_view key) const;

  /// \return the finite number of a key of the root. \param expected  for the message when there is none.
  [[nodiscard]] Result<double> number_at(std::string_view key, std::string_view expected) const;

  /// \return the numbers of a sequence. \param key  for the message.
  [[nodiscard]] Result<std::vector<double>> numbers(const YAML::Node& sequence, std::string_view key) const;

  /// \return the numbers of a matrix as ROS writes it: rows, cols, data.
  [[nodiscard]] Result<std::vector<double>> matrix(std::string_view key, std::string_view expected) const;

  [[nodiscard]] const YAML::Node& root() const { return root_; }

  /// What stands at a node, short, for a message.
  static std::string shown(const YAML::Node& node);

 private:
  const YAML::Node& root_;
  std::string_view name_;
};

}  // namespace cgsr::app
