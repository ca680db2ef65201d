# SPDX-License-Identifier: LGPL-2.1-or-later
# Run at every build: writes version.h from version.h.in when the version or the revision has changed. At
# configuration it would go out of date with the next commit.
#   cmake -Dsource_directory=... -Dtemplate=... -Doutput=... -DPROJECT_VERSION=... -P revision.cmake
find_package(Git QUIET)
set(GEMMULE_GIT_REVISION "unknown")
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} describe --always --dirty
    WORKING_DIRECTORY ${source_directory}
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(status EQUAL 0)
    set(GEMMULE_GIT_REVISION ${revision})
  endif()
endif()
configure_file(${template} ${output} @ONLY)
