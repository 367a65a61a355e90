# touchdown_add_library(<folder> [WITHOUT <regex>...] PUBLIC ... PRIVATE ...)
#   One library per top-level folder: target touchdown_<folder>, alias touchdown::<folder>. Its sources are
#   those in its rooms, the folders below it. WITHOUT leaves out sources whose path there matches.
# touchdown_add_test(<folder> [SOURCES ...] LINK ... [CLOSED_LOOP <filter>])
#   One GoogleTest executable per folder, of all sources in its test/ or of those named. Every TEST becomes a
#   CTest entry with the label unit, or closed_loop where the filter matches it. Closed loops are whole flights,
#   which sanitizers make too slow.
# touchdown_add_bench(<folder> LINK ...)
#   One Google Benchmark executable per folder, <folder>_bench, of bench/; a test runs each for a moment.

# A public header is <folder>/include/touchdown/<folder>/<room>/<file>.h, included as "touchdown/<folder>/...": it
# is installed. An internal one stands beside its source and is included from the root, as
# "<folder>/<room>/<file>.h".

function(touchdown_compile_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                           -Woverloaded-virtual -Wold-style-cast
                                           -Wno-missing-field-initializers)
  # errno is never read after a square root; with it no loop around one is vectorised.
  target_compile_options(${target} PRIVATE -fno-math-errno)
  # GCC 12 has two false warnings. It takes the unset operand in its own AVX-512 intrinsics for a fault, once per use
  # (GCC bug 105593). With AVX2 or AVX-512 it also reports an access out of bounds: a load of four or eight numbers from
  # three, which is never reached.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13
     AND "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_RELEASE}" MATCHES "-march=")
    target_compile_options(${target} PRIVATE -Wno-uninitialized -Wno-maybe-uninitialized
                                             -Wno-array-bounds)
  endif()
  # GCC collects its garbage from 128 MB on by default, again and again: a tenth of its time for this
  # library's templates. From 1 GB on it takes up to 2.1 GB a file. The objects are the same.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE --param=ggc-min-heapsize=1000000)
  endif()
  if(TOUCHDOWN_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(TOUCHDOWN_SANITIZE)
    # With the sanitizer's checks GCC no longer sees that numbers are set before they are read.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)
    endif()
    # A sanitizer finding fails its test.
    target_compile_options(${target} PUBLIC -fsanitize=${TOUCHDOWN_SANITIZE} -fno-sanitize-recover=all
                                            -fno-omit-frame-pointer)
    target_compile_definitions(${target} PUBLIC TOUCHDOWN_SANITIZED)
    target_link_options(${target} PUBLIC -fsanitize=${TOUCHDOWN_SANITIZE})
  endif()
endfunction()

# With CMAKE_UNITY_BUILD, which the presets set, up to twelve sources of a room are compiled together. More than half of
# the time of each alone is for headers that all of them include. So names in anonymous namespaces differ within a room.
function(touchdown_compile_by_room target)
  if(NOT CMAKE_UNITY_BUILD)
    return()
  endif()
  set(at_a_time 12)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # A false warning about headers: GCC takes a source that is compiled with others as a header.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
  set(rooms "")  # of each source so far
  foreach(source IN LISTS ARGN)
    cmake_path(GET source PARENT_PATH room)
    string(MAKE_C_IDENTIFIER "at_${room}" room)
    set(before ${rooms})
    list(FILTER before INCLUDE REGEX "^${room}$")
    list(LENGTH before count)
    math(EXPR group "${count} / ${at_a_time}")
    set_property(SOURCE "${source}" PROPERTY UNITY_GROUP "${room}_${group}")
    list(APPEND rooms "${room}")
  endforeach()
endfunction()

function(touchdown_add_library folder)
  cmake_parse_arguments(ARG "" "" "WITHOUT;PUBLIC;PRIVATE" ${ARGN})
  set(target touchdown_${folder})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE "${CMAKE_CURRENT_SOURCE_DIR}" *.cc)
  foreach(regex "^test/" "^bench/" ${ARG_WITHOUT})
    list(FILTER sources EXCLUDE REGEX "${regex}")
  endforeach()
  add_library(${target} STATIC ${sources})
  touchdown_compile_by_room(${target} ${sources})
  add_library(touchdown::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${folder})
  if(NOT EMSCRIPTEN)  # nothing is loaded at run time in a browser
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  # One memory layout for every consumer and plug-in, whatever -march they are compiled with.
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=16)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  touchdown_compile_options(${target})
  install(TARGETS ${target} EXPORT touchdownTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
endfunction()

function(touchdown_add_test folder)
  if(NOT TOUCHDOWN_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "CLOSED_LOOP" "SOURCES;LINK" ${ARGN})
  set(target ${folder}_test)
  if(NOT ARG_SOURCES)
    file(GLOB ARG_SOURCES CONFIGURE_DEPENDS test/*.cc)
  endif()
  # A test that counts allocations checks first that the counter works.
  if("touchdown_allocations" IN_LIST ARG_LINK AND NOT folder STREQUAL "solvers")
    list(APPEND ARG_SOURCES "${PROJECT_SOURCE_DIR}/solvers/test/allocation_count_test.cc")
  endif()
  add_executable(${target} ${ARG_SOURCES} "${PROJECT_SOURCE_DIR}/cmake/test_main.cc")
  target_link_libraries(${target} PRIVATE ${ARG_LINK} GTest::gmock)
  target_compile_definitions(${target} PRIVATE
    TOUCHDOWN_SOURCE_DIR="${PROJECT_SOURCE_DIR}" TOUCHDOWN_BINARY_DIR="${PROJECT_BINARY_DIR}")
  touchdown_compile_options(${target})
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  if(ARG_CLOSED_LOOP)
    gtest_discover_tests(${target} TEST_FILTER "${ARG_CLOSED_LOOP}" TEST_LIST closed_loop_tests
                         PROPERTIES LABELS "closed_loop;${folder}" DISCOVERY_TIMEOUT 60)
    set(unit_filter TEST_FILTER "-${ARG_CLOSED_LOOP}")
  endif()
  gtest_discover_tests(${target} ${unit_filter} PROPERTIES LABELS "unit;${folder}"
                       DISCOVERY_TIMEOUT 60)
endfunction()

function(touchdown_add_bench folder)
  if(NOT TOUCHDOWN_BUILD_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  set(target ${folder}_bench)
  file(GLOB sources CONFIGURE_DEPENDS bench/*.cc)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE ${ARG_LINK} benchmark::benchmark_main)
  touchdown_compile_options(${target})
  set_target_properties(${target} PROPERTIES UNITY_BUILD OFF)
  if(TOUCHDOWN_BUILD_TESTS)
    add_test(NAME ${target} COMMAND ${target} --benchmark_min_time=0.0001)
    set_tests_properties(${target} PROPERTIES LABELS "unit;${folder}")
  endif()
endfunction()
