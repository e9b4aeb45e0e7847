// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/freed_memory.hpp"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace saccade {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kMiB{1 << 20};
  mallopt(M_MMAP_THRESHOLD, 32 * kMiB);  // the largest value that the C library accepts; larger blocks are returned as
                                         // before
  mallopt(M_TRIM_THRESHOLD, 256 * kMiB);
#endif
}

}  // namespace saccade
