# SPDX-License-Identifier: LGPL-2.1-or-later
# Installs the build, then builds doc/examples/smooth_step against the installed library as a project of its own, and runs
# it. Needs -D: build_directory, source_directory, work_directory, generator, build_type, deal_ii_options.
file(REMOVE_RECURSE ${work_directory})
file(MAKE_DIRECTORY ${work_directory})
set(example ${work_directory}/build)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${build_directory} --prefix ${work_directory}/prefix
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# How Gemmule is compiled is not handed on; what deal.II hands on is its own affair.
file(GLOB_RECURSE targets_file ${work_directory}/prefix/*GemmuleTargets.cmake)
file(READ ${targets_file} targets)
foreach(option -march=native -O3 -g0)
  if("${targets}" MATCHES "${option}" AND NOT "${deal_ii_options}" MATCHES "${option}")
    message(FATAL_ERROR "the package hands on the option ${option}")
  endif()
endforeach()
# Debug sections would make it thirty times as large.
if(build_type STREQUAL "Release")
  file(SIZE ${work_directory}/prefix/bin/gemmule size)
  if(size GREATER 20000000)
    message(FATAL_ERROR "the program has ${size} bytes")
  endif()
endif()

execute_process(COMMAND ${CMAKE_COMMAND} -G "${generator}" -S ${source_directory}/doc/examples/smooth_step -B ${example}
  -DCMAKE_BUILD_TYPE=${build_type} -DCMAKE_PREFIX_PATH=${work_directory}/prefix COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${example} COMMAND_ERROR_IS_FATAL ANY)

file(WRITE ${work_directory}/case.prm "
set End time         = 0.002
set Output directory = ${work_directory}/results
subsection Membrane
  set Initial concentration   = 0.25
  set Surface energy contrast = 0.8
end
subsection Mesh
  set Membrane level       = 4
  set Phase boundary level = 4
end
")
execute_process(COMMAND ${example}/smooth_step ${work_directory}/case.prm COMMAND_ERROR_IS_FATAL ANY)

# The energy per length of the uniform membrane at t = 0: 1 - 0.8 (1/4)^2 (3 - 1/2) = 0.875, where the default energy has
# exp(-0.2) = 0.819. In thousandths, since CMake knows integers only.
file(STRINGS ${work_directory}/results/statistics.csv rows LIMIT_COUNT 2)
list(GET rows 0 names)
list(GET rows 1 values)
string(REPLACE "," ";" names "${names}")
string(REPLACE "," ";" values "${values}")
foreach(name energy_surface arclength)
  list(FIND names ${name} column)
  list(GET values ${column} value)
  if(NOT value MATCHES "^([0-9])\\.([0-9][0-9][0-9][0-9][0-9])")
    message(FATAL_ERROR "unexpected ${name} = ${value}")
  endif()
  math(EXPR ${name} "${CMAKE_MATCH_1} * 100000 + 1${CMAKE_MATCH_2} - 100000")
endforeach()
math(EXPR energy_per_length "(1000 * ${energy_surface} + ${arclength} / 2) / ${arclength}")
if(NOT energy_per_length EQUAL 875)
  message(FATAL_ERROR "the energy per length is ${energy_per_length}/1000 instead of 0.875: is the energy in use?")
endif()
