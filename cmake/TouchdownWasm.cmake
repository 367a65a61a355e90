# For a browser. Emscripten must not see the system's own headers. So header-only libraries are linked into a folder of
# their own.
set(TOUCHDOWN_WASM_HEADERS "${PROJECT_BINARY_DIR}/headers")
file(MAKE_DIRECTORY "${TOUCHDOWN_WASM_HEADERS}")
foreach(library boost nlohmann)
  if(NOT EXISTS "/usr/include/${library}")
    message(FATAL_ERROR "/usr/include/${library} is missing: see packages.txt")
  endif()
  file(CREATE_LINK "/usr/include/${library}" "${TOUCHDOWN_WASM_HEADERS}/${library}" SYMBOLIC)
endforeach()
set(Boost_INCLUDE_DIR "${TOUCHDOWN_WASM_HEADERS}")
set(Eigen3_DIR "/usr/share/eigen3/cmake" CACHE PATH "")

# Exceptions as the browsers have them; two numbers at a time.
add_compile_options(-fwasm-exceptions -msimd128)
add_link_options(-fwasm-exceptions)

# The linker runs scripts in Node. Their modules are where the distribution has them. Some versions have a fetch of
# their own, from which the scripts conclude that they run in a browser.
set(node_options "")
execute_process(COMMAND node --no-experimental-fetch -e 0 RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
if(NOT failed)
  set(node_options "NODE_OPTIONS=--no-experimental-fetch")
endif()
set_property(GLOBAL PROPERTY RULE_LAUNCH_LINK
  "${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs ${node_options}")
