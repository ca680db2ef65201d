# SPDX-License-Identifier: LGPL-2.1-or-later
# gemmule_compile_options(TARGET): how the library, the program and the tests are compiled. The same for all of them, so
# that they can share precompiled headers, and private, so that no project that links the library inherits it. To be
# called after deal_ii_setup_target(), whose options come first then.
function(gemmule_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic
    $<$<BOOL:${GEMMULE_WARNINGS_AS_ERRORS}>:-Werror>
    # -g0: Debian's deal.II hands on the -g that it was built with, and the program would be thirty times as large.
    $<$<CONFIG:Release>:-O3 -g0>
    $<$<BOOL:${GEMMULE_NATIVE_ARCHITECTURE}>:-march=native>)
endfunction()
