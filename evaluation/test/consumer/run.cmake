# Installs BUILD_DIR to a fresh prefix. Then configures, builds and runs against it: this folder and the programs in
# EXAMPLES. Every backend meets the terms of docs/adding_a_term.md; the program of docs/adding_a_backend.md has its own
# backend. The tests of the documents run what is built here.
cmake_minimum_required(VERSION 3.25)

foreach(name BUILD_DIR WORK_DIR EXAMPLES)
  if(NOT ${name})
    message(FATAL_ERROR "run.cmake needs -D${name}=")
  endif()
endforeach()

# run(<status,...> <command...>): fails unless the command ends with one of these statuses.
function(run allowed)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  string(REPLACE "," ";" allowed "${allowed}")
  if(NOT status IN_LIST allowed)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "${command}: status ${status}\n${out}\n${err}")
  endif()
  set(status "${status}" PARENT_SCOPE)
  set(output "${out}" PARENT_SCOPE)
  set(errors "${err}" PARENT_SCOPE)
endfunction()

function(build source name)
  run(0 ${CMAKE_COMMAND} -S "${source}" -B "${WORK_DIR}/${name}" -G Ninja
      "-DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix" "-DEXAMPLES=${EXAMPLES}" ${ARGN})
  run(0 ${CMAKE_COMMAND} --build "${WORK_DIR}/${name}")
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
run(0 ${CMAKE_COMMAND} --install "${BUILD_DIR}" --prefix "${WORK_DIR}/prefix")
run(0 "${WORK_DIR}/prefix/bin/touchdown" list scenarios --json)
build("${CMAKE_CURRENT_LIST_DIR}" consumer)
run(0 "${WORK_DIR}/consumer/consumer")

build("${EXAMPLES}/own_program" own_program)
set(own "${WORK_DIR}/own_program/own_program")
run(0 ${own} list terms --json)
if(NOT output MATCHES "\"reach\"")
  message(FATAL_ERROR "own_program does not list its own term:\n${output}")
endif()
run(0 ${own} check-term reach --trials 2)
run(0 ${own} land open --set timeout=30 --json)

# Every backend flies a second with the term as a cost, and as rows unless it takes none.
run(0 ${own} list backends --json)
set(backends "${output}")
string(JSON count LENGTH "${backends}")
math(EXPR last "${count} - 1")
foreach(i RANGE ${last})
  string(JSON backend GET "${backends}" ${i} name)
  string(JSON compiled GET "${backends}" ${i} compiled)
  if(NOT compiled)
    continue()
  endif()
  set(fly land open --set timeout=1 --set terms.reach.reach=20 --backend ${backend})
  run(1 ${own} ${fly})
  if(errors)
    message(FATAL_ERROR "${backend}: ${errors}")
  endif()
  run(1,2 ${own} ${fly} --set terms.reach.hard=true)
  if(status EQUAL 2 AND NOT errors MATCHES "backend ${backend} .*constraint")
    message(FATAL_ERROR "${backend} refuses rows without a reason: ${errors}")
  endif()
endforeach()

# The solvers alone, though nothing else can be found.
set(lone -DCMAKE_DISABLE_FIND_PACKAGE_octomap=ON -DCMAKE_DISABLE_FIND_PACKAGE_apriltag=ON
         -DCMAKE_DISABLE_FIND_PACKAGE_mujoco=ON -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON)
build("${EXAMPLES}/own_problem" own_problem ${lone})
foreach(i RANGE ${last})
  string(JSON backend GET "${backends}" ${i} name)
  string(JSON compiled GET "${backends}" ${i} compiled)
  if(NOT compiled OR NOT backend MATCHES "^(banded|ipopt)$")
    continue()
  endif()
  run(0 "${WORK_DIR}/own_problem/own_problem" ${backend})
  if(NOT output MATCHES "^converged, cost 984.69")
    message(FATAL_ERROR "own_problem with ${backend}: ${output}")
  endif()
endforeach()

run(0 "${WORK_DIR}/own_problem/swing_up")
if(NOT output MATCHES "^converged after [0-9]+ iterations, effort 67.7")
  message(FATAL_ERROR "swing_up: ${output}")
endif()
run(0 "${WORK_DIR}/own_problem/smoothing")
if(NOT output MATCHES "^converged, cost 0.50")
  message(FATAL_ERROR "smoothing: ${output}")
endif()

# The planner, to a point in a map of one's own.
build("${EXAMPLES}/go_to_goal" go_to_goal)
run(0 "${WORK_DIR}/go_to_goal/go_to_goal")
if(NOT output MATCHES "^there after 5")
  message(FATAL_ERROR "go_to_goal: ${output}")
endif()

# The part that would fly: it lands, and needs neither simulator nor files.
build("${EXAMPLES}/onboard" onboard)
run(0 "${WORK_DIR}/onboard/onboard")
if(NOT output MATCHES "landed 0.0")
  message(FATAL_ERROR "onboard: ${output}")
endif()
run(0 ldd "${WORK_DIR}/onboard/onboard")
if(output MATCHES "mujoco|fcl|OSMesa|sqlite|yaml|mpi")
  message(FATAL_ERROR "onboard is linked with more than it needs:\n${output}")
endif()

# `compare` judges the example backend: by the best cost that any backend found.
build("${EXAMPLES}/own_backend" own_backend)
set(own "${WORK_DIR}/own_backend/own_backend")
foreach(arrival fixed free)
  run(0 ${own} compare --problems 5 --repeats 1 --arrival ${arrival} --backends chord,banded --json
      --allow-debug)
  string(JSON solved GET "${output}" backends chord solved_fraction)
  if(NOT solved EQUAL 1)
    message(FATAL_ERROR "chord solves ${solved} of the problems with ${arrival} arrival:\n${output}")
  endif()
endforeach()
run(0 ${own} land open --backend chord --json)
run(2 ${own} land open --backend chord --set solver.limits=hard)
if(NOT errors MATCHES "backend chord takes no inequality constraints")
  message(FATAL_ERROR "chord refuses rows without a reason: ${errors}")
endif()

# A planner and a pad motion of one's own: every command takes them, with their own keys.
build("${EXAMPLES}/own_parts" own_parts)
set(own "${WORK_DIR}/own_parts/own_parts")
foreach(list planners motions)
  run(0 ${own} list ${list})
  if(NOT output MATCHES "straight.share = 0.9 in|lane.angle_deg = 25 in")
    message(FATAL_ERROR "own_parts does not list its own ${list}:\n${output}")
  endif()
endforeach()
set(parts --set pad.motion=lane_change --set lane.angle_deg=30 --planner straight --set straight.share=0.8)
foreach(style descent=planned descent=vertical task=follow task=go_to)
  run(0 ${own} fly open ${parts} --set ${style} --set go_to.goal=[5,1,1.2] --set timeout=30
      --record "${WORK_DIR}/${style}.db")
  # All that it was asked, asked again.
  run(0 ${own} profile --from "${WORK_DIR}/${style}.db" --repeats 1 --json --allow-debug)
  string(JSON compared GET "${output}" same_as_record compared)
  string(JSON same GET "${output}" same_as_record same)
  if(NOT same EQUAL compared OR compared LESS 20)
    message(FATAL_ERROR "${style}: ${same} of ${compared} answers are the recorded ones")
  endif()
endforeach()
run(0 ${own} sweep open --planner straight --vary pad.motion=lane_change,line --vary straight.share=0.7..0.9
    --trials 4 --json)
run(2 ${own} land open --set pad.motion=lane_chnage)
if(NOT errors MATCHES "waypoints or lane_change")
  message(FATAL_ERROR "an unknown motion: ${errors}")
endif()
run(2 ${own} land open --set lane.angle_deg=200)
if(NOT errors MATCHES "lane.angle_deg must be a number in .5, 90. deg")
  message(FATAL_ERROR "a parameter out of its range: ${errors}")
endif()
file(WRITE "${WORK_DIR}/own_study.yaml" "title: Own parts
report: plain
seed: 1
reference: landing
set: {pad.motion: lane_change, timeout: 30}
cells:
  - {name: lane, title: A lane change, scenario: open, labels: {angle_deg: 20}, set: {lane.angle_deg: 20}}
methods:
  - {name: landing, title: landing, trials: 2}
  - {name: straight, title: straight, set: {planner: straight}, trials: 2}
")
run(0 ${own} study run "${WORK_DIR}/own_study.yaml" --out "${WORK_DIR}/own_study")
