// SPDX-License-Identifier: Apache-2.0
#pragma once
// kParallelBackend: oneTBB, or std::thread where ThreadSanitizer watches, which reports false races in Debian's oneTBB.

#include "saccade/core/executor.hpp"

namespace saccade::test {

#if defined(SACCADE_EXECUTOR_STD_THREAD)
constexpr Executor::Backend kParallelBackend{Executor::Backend::std_thread};
#else
constexpr Executor::Backend kParallelBackend{Executor::Backend::tbb};
#endif

}  // namespace saccade::test
