# SPDX-License-Identifier: LGPL-2.1-or-later
# gemmule_compile_options(TARGET): how the library, the program and the tests are compiled. The same for all of them, so
# that they can share precompiled headers, and private, so that no project that links the library inherits it. To be
# called after deal_ii_setup_target(), whose options come first then.
function(gemmule_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic
    $<$<BOOL:${GEMMULE_WARNINGS_AS_ERRORS}>:-Werror>
    # -g0: Debian's deal.II hands on the -g that it was built with, and the program would be thirty times as large.
    $<$<CONFIG:Release>:-O3 -g0>
    $<$<BOOL:${GEMMULE_NATIVE_ARCHITECTURE}>:-march=native>
    # The files of a unity build are included, and what is unnamed in a header may well deserve a warning.
    $<$<BOOL:${CMAKE_UNITY_BUILD}>:-Wno-subobject-linkage>)
endfunction()

# gemmule_unity_groups(TARGET SOURCE...): with CMAKE_UNITY_BUILD, up to six files of one folder are compiled as one. Most of
# a file's time goes into templates of deal.II that its neighbours use as well. Files whose names would collide with those
# of a neighbour's unnamed namespace have the property SKIP_UNITY_BUILD_INCLUSION.
function(gemmule_unity_groups target)
  set(files_per_group 6)
  foreach(source ${ARGN})
    get_source_file_property(is_alone ${source} SKIP_UNITY_BUILD_INCLUSION)
    if(NOT is_alone)
      get_filename_component(folder ${source} DIRECTORY)
      get_filename_component(folder ${folder} NAME)
      math(EXPR group "0${n_${folder}} / ${files_per_group}")
      math(EXPR n_${folder} "0${n_${folder}} + 1")
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${group})
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()
