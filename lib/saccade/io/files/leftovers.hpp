// SPDX-License-Identifier: Apache-2.0
#pragma once
// Leftovers: temporary files of AtomicFile that a process left when it was killed.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace saccade {

/// Name of a temporary file: ".NAME.PID-N.tmp".
struct TemporaryName {
  std::string destination;  ///< NAME
  int process{0};           ///< PID of its writer
};

/// Makes the name of the next temporary file of this process.
[[nodiscard]] std::string make_temporary_name(std::string_view destination);
/// Parses a file's name; nullopt for one of any other form.
[[nodiscard]] std::optional<TemporaryName> parse_temporary_name(std::string_view name);

/// Tells whether a temporary file is locked by its writer, on this machine or another; also where it cannot be opened.
[[nodiscard]] bool is_written_to(const std::filesystem::path& temporary);

/// Removes the temporary files of `destination` that lie beside it and whose processes are gone. A file that is locked
/// stays, since its process may be on another machine or in another container. Ignores errors. Looks
/// at the first 2,000 names of the folder.
void remove_leftovers(const std::filesystem::path& destination);

}  // namespace saccade
