// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where the tests find the checkout, the recorded data and the programs. Only places.cpp holds these paths, so that the
// objects of all other sources are the same in every checkout and come out of the compiler's cache.

#include <filesystem>
#include <string>

namespace saccade::test {

/// Root of the checkout.
[[nodiscard]] std::filesystem::path source_folder();

/// Recorded data beside the checkout (`../shared/data`); it may be missing.
[[nodiscard]] std::filesystem::path shared_data();

/// A box and a cylinder on half a metre of table: what an exploration takes a third of a second for, with images of
/// 96 x 72 pixels and voxels of 15 mm.
[[nodiscard]] std::string tiny_cell_file();

/// The command line as it was built with the tests.
[[nodiscard]] const char* saccade_program();

/// saccade-NAME, a program of a device; it may be missing.
[[nodiscard]] std::filesystem::path device_program(const std::string& name);

/// A program that was built from examples/NAME.cpp; it may be missing.
[[nodiscard]] std::filesystem::path example_program(const std::string& name);

}  // namespace saccade::test
