# SPDX-License-Identifier: LGPL-2.1-or-later
# Finds the MPI build of MUMPS (double precision) and defines the target MUMPS::dmumps.
find_path(MUMPS_INCLUDE_DIR dmumps_c.h PATH_SUFFIXES mumps MUMPS)
find_library(MUMPS_LIBRARY dmumps)
find_library(MUMPS_COMMON_LIBRARY mumps_common)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MUMPS REQUIRED_VARS MUMPS_LIBRARY MUMPS_COMMON_LIBRARY MUMPS_INCLUDE_DIR)
if(MUMPS_FOUND AND NOT TARGET MUMPS::dmumps)
  add_library(MUMPS::dmumps INTERFACE IMPORTED)
  set_target_properties(MUMPS::dmumps PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${MUMPS_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${MUMPS_LIBRARY};${MUMPS_COMMON_LIBRARY}")
endif()
mark_as_advanced(MUMPS_INCLUDE_DIR MUMPS_LIBRARY MUMPS_COMMON_LIBRARY)
