// SPDX-License-Identifier: Apache-2.0
// No include guard: a source file with vector kernels includes this file first, instead of Highway itself, after
// defining HWY_TARGET_INCLUDE as its own path. Highway then compiles the file once per instruction set.
//
// AVX3_DL is excluded: no kernel here uses its additions.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_AVX3_DL
#endif
#include <hwy/foreach_target.h>  // IWYU pragma: keep
#include <hwy/highway.h>
