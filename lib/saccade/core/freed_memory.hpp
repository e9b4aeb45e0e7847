// SPDX-License-Identifier: Apache-2.0
#pragma once
// keep_freed_memory: for programs that take frame after frame.

namespace saccade {

/// Has the process keep what it frees, up to 256 MiB, for what it asks for next. Images of a frame are some megabytes
/// each, and such blocks the GNU C library asks of the system and gives back every time; the system clears them page by
/// page, which on a virtual machine may take longer than the frame itself. For a program to call once at its start,
/// before other threads allocate; the library never does. Where there is no mallopt(3) of the GNU C library, nothing
/// happens.
void keep_freed_memory();

}  // namespace saccade
