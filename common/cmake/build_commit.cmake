# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT with the commit of SOURCE; touches it only when the commit changed.
execute_process(COMMAND git describe --always --dirty=+ --abbrev=12 --match=-
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
  ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define SHOAL_BUILD_COMMIT \"${commit}\"\n")
