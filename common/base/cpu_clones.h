// SPDX-License-Identifier: Apache-2.0
// SHOAL_CPU_CLONES before a function makes the compiler build the function for several generations
// of x86-64 CPUs. The loader selects one of these versions, so that plain loops use the widest
// vectors of the machine. Templates cannot use this macro.
//
// The selection is made by ifunc resolvers, which run before the thread sanitizer is ready. A build
// with the thread sanitizer therefore has the default version only.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_THREAD__)
#define SHOAL_CPU_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define SHOAL_CPU_CLONES
#endif
