# SPDX-License-Identifier: Apache-2.0
set(SHOAL_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Woverloaded-virtual)
if(SHOAL_WARNINGS_AS_ERRORS)
  list(APPEND SHOAL_WARNINGS -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
  # This warning reports references to objects that live long, if the function that returns the
  # reference has a temporary as its argument, for example FindTask("Hopper-v5").
  list(APPEND SHOAL_WARNINGS -Wno-dangling-reference)
endif()

# For builds without a compiler cache: compiles sources of a target in groups, which takes 0.6 of the time.
# Every source must still compile alone, as builds with a cache ensure.
option(SHOAL_UNITY "Compile sources in groups" OFF)
set(SHOAL_UNITY_GROUP 8 CACHE STRING "Sources in a group")
if(SHOAL_UNITY)
  set(CMAKE_UNITY_BUILD ON)
  set(CMAKE_UNITY_BUILD_BATCH_SIZE ${SHOAL_UNITY_GROUP})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # which warns as if the anonymous namespace were in a header
    list(APPEND SHOAL_WARNINGS -Wno-subobject-linkage)
  endif()
endif()

# shoal_large_groups(TARGET): for a target that programs link completely. A program that uses a part
# of a library links whole groups and starts more slowly, so such libraries keep groups of
# SHOAL_UNITY_GROUP.
function(shoal_large_groups target)
  if(SHOAL_UNITY_GROUP LESS 32)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 32)
  endif()
endfunction()

function(shoal_warnings target)
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${SHOAL_WARNINGS}>)
endfunction()

# Used in builds without a compiler cache, because they would invalidate its entries. Every source must
# still include what it uses, as builds with a cache ensure.
option(SHOAL_PRECOMPILED_HEADERS "Compile the headers that most sources include once" OFF)

# shoal_precompiled(HOLDER HEADERS...): precompiles HEADERS; HOLDER has the same options as its users.
function(shoal_precompiled holder)
  shoal_warnings(${holder})
  if(SHOAL_PRECOMPILED_HEADERS)
    target_precompile_headers(${holder} PRIVATE ${ARGN})
  endif()
endfunction()

# shoal_precompile(NAME HOLDER): the sources of NAME use the precompiled headers of HOLDER.
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

# If SHOAL_COLD is set, a folder's libraries and programs are compiled for a short build: code that starts,
# watches and reports computes little. The headers of CLI11 and nlohmann-json are not precompiled: they
# would cost every source seconds, and most sources do not use them.
set(SHOAL_COLD_OPTIONS $<$<CONFIG:Release>:-O1>)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)  # g++ 12 has false warnings at low optimisation
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

# shoal_cold_sources(SOURCES...): the same for single sources of another library.
function(shoal_cold_sources)
  set_source_files_properties(${ARGN} PROPERTIES
    COMPILE_OPTIONS "${SHOAL_COLD_OPTIONS}" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# shoal_hot(SOURCES...): sources that dominate the time of tests in unoptimised builds, such as those
# of the sanitizers. There they are compiled with SHOAL_HOT_OPTIONS.
function(shoal_hot)
  if(SHOAL_HOT_OPTIONS)
    set_source_files_properties(${ARGN} PROPERTIES
      COMPILE_OPTIONS "${SHOAL_HOT_OPTIONS}" SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# shoal_exports(PROGRAM LIBRARIES...): links these libraries completely into the program, for the
# shared objects that it loads (docs/own_task.md).
function(shoal_exports program)
  target_link_libraries(${program} PRIVATE ${ARGN})
  foreach(library ${ARGN})
    target_link_options(${program} PRIVATE
      LINKER:--whole-archive $<TARGET_FILE:${library}> LINKER:--no-whole-archive)
  endforeach()
  set_target_properties(${program} PROPERTIES ENABLE_EXPORTS ON)
endfunction()
