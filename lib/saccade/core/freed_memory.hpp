// SPDX-License-Identifier: Apache-2.0
#pragma once
// keep_freed_memory: for programs that process frame after frame.

namespace saccade {

/// Lets the process keep up to 256 MiB of freed memory for its next allocations. Images of a frame take some megabytes
/// each. By default the GNU C library requests such blocks from the system and returns them every time. The system then
/// clears them page by page, which on a virtual machine may take longer than the frame itself. A program calls this
/// once at its start, before other threads allocate; the library never does. Does nothing where the C library has no
/// mallopt(3).
void keep_freed_memory();

}  // namespace saccade
