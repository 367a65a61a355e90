cmake_policy(VERSION 3.25)
# Runs at every build (cmake -P). Writes the revision of the sources to HEADER, and touches it only
# when it changed.
#   cmake -DSOURCE_DIR=<repository> -DHEADER=<file> -P TouchdownRevision.cmake
execute_process(
  COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(revision "unknown")
endif()
file(CONFIGURE OUTPUT "${HEADER}"
     CONTENT "#define TOUCHDOWN_REVISION \"@revision@\"\n" @ONLY)
