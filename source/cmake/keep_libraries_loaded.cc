// SPDX-License-Identifier: LGPL-2.1-or-later
// For the sanitizers only: part of every program that they instrument. A library that has been unloaded
// before the process ends (Open MPI does that with its plugins) has no name in the report of leaks any more,
// so that no suppression of tests/support/lsan.supp would match. So none is.
extern "C" int dlclose(void *)
{
  return 0;
}
