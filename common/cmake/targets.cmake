# shoal_library(NAME SOURCES...): one static library per folder, with the project's warnings.
set(SHOAL_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wnon-virtual-dtor -Woverloaded-virtual)
if(SHOAL_WARNINGS_AS_ERRORS)
  list(APPEND SHOAL_WARNINGS -Werror)
endif()

function(shoal_warnings target)
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${SHOAL_WARNINGS}>)
endfunction()

function(shoal_library name)
  add_library(${name} STATIC ${ARGN})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
  shoal_warnings(${name})
endfunction()

function(shoal_program name)
  add_executable(${name} ${ARGN})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  shoal_warnings(${name})
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
