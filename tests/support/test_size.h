// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdlib>
#include <string>

namespace Gemmule::Testing
{
/**
 * How many times slower the programs may be than optimised ones: deal.II's debug library takes about ten
 * times as long, and address sanitizers twice as long again. All time limits of the tests are multiplied by
 * it.
 */
constexpr unsigned int slowness =
#if defined(__SANITIZE_ADDRESS__)
    20;
#elif defined(DEBUG)
    10;
#else
    1;
#endif

/**
 * Whether the environment variable GEMMULE_REDUCED_TESTS asks the few tests that take the longest for shorter
 * runs and coarser meshes: for sanitizers, which look at what the program does and not at its accuracy. Each
 * of them says what it leaves out.
 */
inline bool is_reduced()
{
  return std::getenv("GEMMULE_REDUCED_TESTS") != nullptr;
}

/** A time limit as a prefix of a command: the seconds that optimised programs may take. */
inline std::string time_limit(const unsigned int seconds)
{
  return "timeout " + std::to_string(seconds * slowness) + " ";
}
} // namespace Gemmule::Testing
