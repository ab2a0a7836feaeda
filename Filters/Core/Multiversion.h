// SPDX-License-Identifier: BSD-3-Clause
/// @file Multiversion.h
/// @brief One binary, several instruction sets.
#pragma once

/// Before a function with a hot, vectorisable loop: the compiler makes a clone of it for AVX2 and one
/// for AVX-512 beside the baseline, and the loader picks the best that the machine has. No clone fuses
/// multiply and add (-ffp-contract=off), so all give the same bits. Only functions defined in a .cxx
/// file can have it, and what they call is cloned along only where it is inlined. Under a sanitizer
/// and on other compilers there is the baseline alone.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(NURBS_SANITIZE)
#define NURBS_MULTIVERSION \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
/// 1 where NURBS_MULTIVERSION makes clones, else 0.
#define NURBS_HAS_CLONES 1
#else
#define NURBS_MULTIVERSION
#define NURBS_HAS_CLONES 0
#endif

namespace nurbs
{

/// True where a NURBS_MULTIVERSION function has 32-byte registers. Code with vector types asks, as
/// GCC makes slow code of vectors that are too wide for the baseline.
inline bool HasWideClones()
{
#if NURBS_HAS_CLONES
  static const bool wide = __builtin_cpu_supports("x86-64-v3");
  return wide;
#else
  return false;
#endif
}

} // namespace nurbs
