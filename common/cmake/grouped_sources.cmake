# SPDX-License-Identifier: Apache-2.0
# Writes BUILD/grouped_sources.txt: "TARGET SOURCE" for each C++ source that a build without a
# compiler cache compiles together with others of its target (SHOAL_UNITY). tests/layering checks
# that their names do not collide, in builds with a cache as well.

# shoal_grouped_sources(TARGET FOLDER SOURCES...): relative sources are relative to FOLDER.
function(shoal_grouped_sources target folder)
  set(lines)
  foreach(source ${ARGN})
    cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} NORMALIZE)
    get_source_file_property(alone ${source} DIRECTORY ${folder} SKIP_UNITY_BUILD_INCLUSION)
    cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${source} is_generated)
    if(source MATCHES "\\.cpp$" AND NOT alone AND NOT is_generated)
      cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
      string(APPEND lines "${target} ${source}\n")
    endif()
  endforeach()
  set_property(GLOBAL APPEND_STRING PROPERTY SHOAL_GROUPED_SOURCES "${lines}")
endfunction()

function(shoal_grouped_sources_below folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(sources ${target} SOURCES)
    get_target_property(grouped ${target} UNITY_BUILD)  # NOTFOUND if it is not set
    if(sources AND NOT grouped STREQUAL "OFF")
      list(FILTER sources EXCLUDE REGEX "^\\$<")
      shoal_grouped_sources(${target} ${folder} ${sources})
    endif()
  endforeach()
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(inner ${folders})
    shoal_grouped_sources_below(${inner})
  endforeach()
endfunction()

# Called last, after all targets are defined.
function(shoal_write_grouped_sources)
  shoal_grouped_sources_below(${PROJECT_SOURCE_DIR})
  get_property(lines GLOBAL PROPERTY SHOAL_GROUPED_SOURCES)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/grouped_sources.txt CONTENT "${lines}" @ONLY)
endfunction()
