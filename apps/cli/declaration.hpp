// SPDX-License-Identifier: Apache-2.0
#pragma once
// Options and Declared: the options of a command, each declared once: name, value, unit, range, default and help.
// Parsing, --help, manual pages, completion and docs/reference/cli.md are made of the declarations.

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "add_value.hpp"
#include "options.hpp"

namespace saccade::cli {

/// An option or argument that was declared; to say more of it.
class Declared {
 public:
  explicit Declared(CLI::Option* option) : option_{option} {}

  const Declared& required() const { return option_->required(), *this; }
  template <class T>
  const Declared& range(T least, T most) const {
    return option_->check(CLI::Range(least, most)), *this;
  }
  /// A whole number from 0 on; CLI11 itself takes -1 for the largest one.
  const Declared& whole_number() const { return option_->check(check_whole_number), *this; }
  const Declared& excludes(const std::string& other) const { return option_->excludes(other), *this; }
  const Declared& delimiter(char separator) const { return option_->delimiter(separator), *this; }

 private:
  CLI::Option* option_;
};

/// A folder of results, as it is declared.
struct FolderOption {
  std::string value{"DIR"};
  std::string help;
  std::vector<std::string_view> files{};  ///< what an earlier run may have left in it
  std::string_view document{};            ///< file for the result in its envelope, written last; empty: none
  std::string_view marker{};              ///< file by which an earlier run is known; empty: the document
  bool required{false};
  std::function<std::string()> otherwise{};  ///< names the folder where --out is not given; none: there is no folder
  bool opened_by_command{false};             ///< with Context::open_folder, where something has to be read before
};

/// A folder of results, as it was asked for.
struct FolderRequest : FolderOption {
  std::filesystem::path path{};
  bool force{false};
};

class Options {
 public:
  Options(CLI::App& command, FolderRequest& folder) : command_{command}, folder_{folder} {}

  /// Declares an option, or for a name without dashes an argument, that sets `target`. `unit` stands for its value in
  /// the help (METRES, N, FILE), which shows the default of numbers and texts.
  template <class T>
  Declared value(const std::string& name, T& target, const std::string& unit, const std::string& help) {
    return Declared{add_value(command_, name, target, unit, help)};
  }
  /// Declares a switch. "--no-mesh{false}" sets its target to false.
  Declared flag(const std::string& name, bool& target, const std::string& help) {
    return Declared{command_.add_flag(name, target, help)};
  }
  template <class T, std::size_t N, class Target>
  Declared choice(const std::string& name, Target& target, const Names<T, N>& names, const std::string& help) {
    return Declared{add_choice(command_, name, target, names, help)};
  }
  /// Declares an angle: degrees outside, radians inside.
  Declared angle(const std::string& name, double& target_rad, const std::string& help);
  void point(const std::string& name, std::optional<Eigen::Vector3d>& target, const std::string& help) {
    add_point(command_, name, target, help);
  }
  void box(const std::string& name, std::optional<Box>& target, const std::string& help) {
    add_box(command_, name, target, help);
  }
  void lengths(const std::string& name, std::vector<double>& target_m, const std::string& help) {
    add_lengths(command_, name, target_m, help);
  }
  /// Declares a direction, which becomes a unit vector.
  void direction(const std::string& name, std::optional<Eigen::Vector3d>& target, const std::string& help);
  /// Declares --out and --force.
  void folder(FolderOption folder);

  /// The folder as it was asked for, once the command line was parsed; lives as long as the command.
  [[nodiscard]] const FolderRequest& request() const { return folder_; }

  /// For option groups that commands share and that are declared on CLI11's command (options.hpp, frame_options.hpp …).
  [[nodiscard]] CLI::App& group() { return command_; }

 private:
  CLI::App& command_;
  FolderRequest& folder_;
};

}  // namespace saccade::cli
