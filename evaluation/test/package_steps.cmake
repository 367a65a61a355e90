# Shared beginning of the package tests: functions, a fresh WORK_DIR, and an environment that names no other
# installation.
# need(<variable>...): fails unless each was given with -D.
function(need)
  foreach(name IN LISTS ARGN)
    if(NOT ${name})
      message(FATAL_ERROR "run.cmake needs -D${name}=")
    endif()
  endforeach()
endfunction()

# run(<command...>): fails unless the command ends with status 0.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err
                  WORKING_DIRECTORY "${WORK_DIR}")
  if(NOT status EQUAL 0)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "${command}: status ${status}\n${out}\n${err}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

need(WORK_DIR)
file(REMOVE_RECURSE "${WORK_DIR}")
file(MAKE_DIRECTORY "${WORK_DIR}")
foreach(name PYTHONPATH TOUCHDOWN_PROGRAM PYTHONHOME)
  unset(ENV{${name}})
endforeach()
