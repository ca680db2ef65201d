// SPDX-License-Identifier: LGPL-2.1-or-later
// What the tests of runs that are interrupted compare with.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

TEST(UninterruptedRun, IsComputed)
{
  const TemporaryDirectory temporary;
  const char *const shared = std::getenv("GEMMULE_SURVIVAL_REFERENCE");
  const Directory directory(shared != nullptr ? shared : temporary.path);
  std::filesystem::remove_all(directory.path);
  std::filesystem::create_directories(directory.path);
  compute_reference(directory);
}
