# Makes the Debian package of what BUILD_DIR holds, looks at what it says and holds, and flies with what was unpacked: from
# elsewhere.
cmake_minimum_required(VERSION 3.25)

include("${CMAKE_CURRENT_LIST_DIR}/../package_steps.cmake")
need(SOURCE_DIR BUILD_DIR WORK_DIR VERSION PYTHON)

# holds(<text> <regex>...): fails unless each is there.
function(holds text)
  foreach(regex IN LISTS ARGN)
    if(NOT text MATCHES "${regex}")
      message(FATAL_ERROR "there is no ${regex} in\n${text}")
    endif()
  endforeach()
endfunction()

cmake_path(GET CMAKE_COMMAND PARENT_PATH programs)
run("${programs}/cpack" -G DEB --config "${BUILD_DIR}/CPackConfig.cmake" -B "${WORK_DIR}")
file(GLOB package "${WORK_DIR}/*.deb")
cmake_path(GET package FILENAME name)
holds("${name}" "^touchdown_${VERSION}-1~[a-z]+[0-9.]*_[a-z0-9]+\\.deb$")

run(dpkg-deb --field "${package}")
holds("${output}" "Version: ${VERSION}-1~" "Depends: python3 \\(>= 3[^\n]*python3-numpy, python3-pandas[^\n]*libmujoco"
      "Recommends: [^\n]*python3-scipy" "Maintainer: [^\n]+ <[^\n]+>\n")
run(dpkg-deb --info "${package}" postinst prerm)
holds("${output}" "py3compile -p touchdown" "py3clean -p touchdown")

run(dpkg-deb --contents "${package}")
holds("${output}" "-rwxr-xr-x root/root [^\n]* ./usr/bin/touchdown\n"
      "-rw-r--r-- root/root [^\n]* ./usr/lib/python3/dist-packages/touchdown/_touchdown.cpython-[^\n/]*.so\n"
      "./usr/share/man/man1/touchdown.1.gz\n"
      "./usr/share/touchdown/scenarios/straight_turn.yaml\n" "./usr/share/touchdown/studies/paper.yaml\n"
      "./usr/share/touchdown/data/replay/replay.js\n" "./usr/share/touchdown/python/touchdown_report/landing.py\n"
      "./usr/share/doc/touchdown/copyright\n" "./usr/share/doc/touchdown/changelog.Debian.gz\n"
      "./usr/share/doc/touchdown/docs/README.md\n")
if(output MATCHES "[^\n]*(__pycache__|usr/include|\\.a\n|/usr/local)[^\n]*")
  message(FATAL_ERROR "the package holds ${CMAKE_MATCH_0}")
endif()
string(REGEX MATCHALL "drwx[^\n]*" folders "${output}")
list(FILTER folders EXCLUDE REGEX "^drwxr-xr-x root/root ")
if(folders)
  message(FATAL_ERROR "folders that not all may enter: ${folders}")
endif()

run(dpkg-deb --extract "${package}" unpacked)
file(GLOB module "${WORK_DIR}/unpacked/usr/lib/python3/dist-packages/touchdown/_touchdown.*.so")
foreach(binary "${WORK_DIR}/unpacked/usr/bin/touchdown" "${module}")
  run(readelf --dynamic "${binary}")
  holds("${output}" "NEEDED")
  if(output MATCHES "[^\n]*(RPATH|RUNPATH)[^\n]*")
    message(FATAL_ERROR "${binary} looks for libraries elsewhere: ${CMAKE_MATCH_0}")
  endif()
  file(STRINGS "${binary}" paths REGEX "${SOURCE_DIR}")
  if(paths)
    message(FATAL_ERROR "${binary} names the tree that it was built in: ${paths}")
  endif()
endforeach()
run(gzip -dc unpacked/usr/share/man/man1/touchdown.1.gz)
holds("${output}" "\n\\.SS \"touchdown land " "\n\\.SS \"touchdown study hostile " "\n\\.B \\\\-\\\\-html F\\.html\n"
      "\n\\.B SCENARIO TEXT=straight_turn\n" "touchdown ${VERSION}")
run(gzip -dc unpacked/usr/share/doc/touchdown/changelog.Debian.gz)
holds("${output}" "^touchdown \\(${VERSION}-1\\) ")

# Every copyright and licence of what came from elsewhere.
file(READ "${WORK_DIR}/unpacked/usr/share/doc/touchdown/copyright" copyright)
file(GLOB_RECURSE files "${WORK_DIR}/unpacked/usr/share/touchdown/LICENCES.txt")
list(LENGTH files count)
if(count LESS 2)
  message(FATAL_ERROR "these are all licences: ${files}")
endif()
foreach(file IN LISTS files)
  file(STRINGS "${file}" notices REGEX "^Copyright |copyright \\(c\\)" ENCODING UTF-8)
  list(LENGTH notices count)
  if(count LESS 2)
    message(FATAL_ERROR "${file}: whose licences are these? ${notices}")
  endif()
  foreach(notice IN LISTS notices)
    string(REGEX REPLACE "^.*[Cc]opyright ((\\(c\\)|©) )?" "" holder "${notice}")
    string(REGEX REPLACE "\\.( *All rights reserved\\.)?$" "" holder "${holder}")
    string(FIND "${copyright}" "${holder}" at)
    if(at LESS 0)
      message(FATAL_ERROR "the copyright of the package does not name ${holder} of ${file}")
    endif()
  endforeach()
endforeach()

run("${PYTHON}" -B "${CMAKE_CURRENT_LIST_DIR}/links.py" unpacked/usr/share/doc/touchdown)

set(ENV{PYTHONPATH} "${WORK_DIR}/unpacked/usr/lib/python3/dist-packages")
run("${PYTHON}" "${CMAKE_CURRENT_LIST_DIR}/../pip/check.py" "${WORK_DIR}/unpacked/usr")
run(unpacked/usr/bin/touchdown land straight_turn --record landing.db --html landing.html --plot landing.png)
run(unpacked/usr/bin/touchdown export landing.db --mcap landing.mcap)
