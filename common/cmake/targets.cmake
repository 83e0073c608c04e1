# SPDX-License-Identifier: Apache-2.0
set(SHOAL_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Woverloaded-virtual)
if(SHOAL_WARNINGS_AS_ERRORS)
  list(APPEND SHOAL_WARNINGS -Werror)
endif()

# For builds without a compiler cache: sources of a target are compiled in groups, as one each, which takes
# 0.6 of the time. Every source is complete and compiles alone all the same: builds with a cache see to that.
option(SHOAL_UNITY "Compile sources in groups" OFF)
set(SHOAL_UNITY_GROUP 8 CACHE STRING "Sources in a group")
if(SHOAL_UNITY)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE ${SHOAL_UNITY_GROUP})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # which takes an anonymous namespace for a header's
    list(APPEND SHOAL_WARNINGS -Wno-subobject-linkage)
  endif()
endif()

# shoal_large_groups(TARGET): for a target that programs link whole. A program that links a part of a
# library gets whole groups of it, and starts later: such libraries keep groups of SHOAL_UNITY_GROUP.
function(shoal_large_groups target)
  if(SHOAL_UNITY_GROUP LESS 32)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 32)
  endif()
endfunction()

function(shoal_warnings target)
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${SHOAL_WARNINGS}>)
endfunction()

# For builds without a compiler cache, whose entries they would outdate. Every source includes what it
# uses all the same: builds with a cache see to that.
option(SHOAL_PRECOMPILED_HEADERS "Compile the headers that most sources include once" OFF)

# shoal_precompiled(HOLDER HEADERS...): makes them; HOLDER is compiled as those who use them are.
function(shoal_precompiled holder)
  shoal_warnings(${holder})
  if(SHOAL_PRECOMPILED_HEADERS)
    target_precompile_headers(${holder} PRIVATE ${ARGN})
  endif()
endfunction()

# shoal_precompile(NAME HOLDER): its sources use HOLDER's.
function(shoal_precompile name holder)
  if(SHOAL_PRECOMPILED_HEADERS)
    target_precompile_headers(${name} REUSE_FROM ${holder})
  endif()
endfunction()

file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/headers.cpp CONTENT "// Holds precompiled headers.\nint main() {}\n")
add_library(shoal_library_headers OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/headers.cpp)
set(SHOAL_COMMON_HEADERS <algorithm> <chrono> <cmath> <cstdint> <filesystem> <functional> <map> <memory>
  <optional> <span> <string> <string_view> <utility> <vector>)
shoal_precompiled(shoal_library_headers ${SHOAL_COMMON_HEADERS})

# Code that starts, watches and reports computes little: where SHOAL_COLD is set, a folder's libraries and
# programs are compiled for a short build. The headers of CLI11 and nlohmann-json are not precompiled: every
# source would pay seconds for them, and most do not use them.
set(SHOAL_COLD_OPTIONS $<$<CONFIG:Release>:-O1>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # g++ 12 sees what is not there when it optimises little
  list(APPEND SHOAL_COLD_OPTIONS -Wno-array-bounds -Wno-maybe-uninitialized -Wno-stringop-overflow)
endif()
add_library(shoal_cold_headers OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/headers.cpp)
target_compile_options(shoal_cold_headers PRIVATE ${SHOAL_COLD_OPTIONS})
shoal_precompiled(shoal_cold_headers ${SHOAL_COMMON_HEADERS})

# shoal_library(NAME SOURCES...): one static library per folder, with the project's warnings.
function(shoal_library name)
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  shoal_warnings(${name})
  if(SHOAL_COLD)
    shoal_precompile(${name} shoal_cold_headers)
    target_compile_options(${name} PRIVATE ${SHOAL_COLD_OPTIONS})
    shoal_large_groups(${name})
  else()
    shoal_precompile(${name} shoal_library_headers)
  endif()
endfunction()

function(shoal_program name)
  add_executable(${name} ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE shoal_program_start)  # common/base/openmp_binding.h
  shoal_warnings(${name})
  if(SHOAL_COLD)
    target_compile_options(${name} PRIVATE ${SHOAL_COLD_OPTIONS})
  endif()
endfunction()

# shoal_cold_sources(SOURCES...): the same for some sources of another library.
function(shoal_cold_sources)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "${SHOAL_COLD_OPTIONS}" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# shoal_hot(SOURCES...): where an unoptimised build, as the sanitizers' are, would spend its tests'
# time: compiled with SHOAL_HOT_OPTIONS there.
function(shoal_hot)
  if(SHOAL_HOT_OPTIONS)
    set_source_files_properties(${ARGN} PROPERTIES
      COMPILE_OPTIONS "${SHOAL_HOT_OPTIONS}" SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# shoal_exports(PROGRAM LIBRARIES...): the program has all of these libraries, whether or not it uses
# it itself, for the shared objects that it loads (docs/own_task.md).
function(shoal_exports program)
  target_link_libraries(${program} PRIVATE ${ARGN})
  foreach(library ${ARGN})
    target_link_options(${program} PRIVATE
      LINKER:--whole-archive $<TARGET_FILE:${library}> LINKER:--no-whole-archive)
  endforeach()
  set_target_properties(${program} PROPERTIES ENABLE_EXPORTS ON)
endfunction()
