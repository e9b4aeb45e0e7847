// SPDX-License-Identifier: Apache-2.0
// In every benchmark: ours and peers alike find memory in the heap, as in the program
// (docs/decisions/0022-freed-memory.md).
#include "saccade/core/freed_memory.hpp"

namespace {

[[maybe_unused]] const bool kept = (saccade::keep_freed_memory(), true);

}  // namespace
