# Installs the Python package of BUILD_DIR by pip into a fresh environment and by CMake into a fresh prefix. Flies with
# each, without the network and from elsewhere.
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/../package_steps.cmake")
need(SOURCE_DIR BUILD_DIR WORK_DIR PYTHON)

set(check "${CMAKE_CURRENT_LIST_DIR}/check.py")

run("${PYTHON}" -m venv --system-site-packages venv)
set(ENV{TOUCHDOWN_BUILD_DIR} "${BUILD_DIR}")
run(venv/bin/python -m pip install --no-index --no-build-isolation --no-cache-dir "${SOURCE_DIR}")
unset(ENV{TOUCHDOWN_BUILD_DIR})
run(venv/bin/python "${check}" "${WORK_DIR}/venv")
run(venv/bin/touchdown list scenarios)
if(NOT output MATCHES "straight_turn")
  message(FATAL_ERROR "the command touchdown lists no shipped scenario:\n${output}")
endif()
run(venv/bin/python -m pip uninstall -y touchdown)
file(GLOB_RECURSE left "${WORK_DIR}/venv/*/touchdown*")
if(left)
  message(FATAL_ERROR "uninstalled, and yet there: ${left}")
endif()

# The component alone, then all of it: the program of the prefix is the package's.
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix prefix --component python)
if(EXISTS "${WORK_DIR}/prefix/bin" OR EXISTS "${WORK_DIR}/prefix/include")
  message(FATAL_ERROR "the component python holds more than the package")
endif()
file(GLOB packages "${WORK_DIR}/prefix/lib/python3.*/dist-packages")
run(${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix prefix)
set(ENV{PYTHONPATH} "${packages}")
run("${PYTHON}" "${check}" "${WORK_DIR}/prefix")
