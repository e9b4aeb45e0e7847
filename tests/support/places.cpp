// SPDX-License-Identifier: Apache-2.0
#include "support/places.hpp"

namespace saccade::test {

namespace fs = std::filesystem;

fs::path source_folder() { return SACCADE_SOURCE_DIR; }

fs::path shared_data() { return fs::path{SACCADE_SOURCE_DIR "/../shared/data"}; }

std::string tiny_cell_file() { return SACCADE_SOURCE_DIR "/tests/support/tiny_cell.yaml"; }

const char* saccade_program() { return SACCADE_BINARY_DIR "/saccade"; }

fs::path device_program(const std::string& name) { return fs::path{SACCADE_BINARY_DIR} / ("saccade-" + name); }

fs::path example_program(const std::string& name) {
  return fs::path{SACCADE_BINARY_DIR "/examples"} / ("example_" + name);
}

}  // namespace saccade::test
