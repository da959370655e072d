# How a folder registers its tests. ctest sees them as <folder>.<name>.
set(sanitizer_options "ASAN_OPTIONS=detect_leaks=1" "UBSAN_OPTIONS=print_stacktrace=1")

option(FLEXCOMP_TEST_ONCE "Leave out unit tests that the debug build runs with sanitizers" OFF)

# A unit test of the host or of the node, as below, that need not run in two builds.
function(flexcomp_host_test)
  if(FLEXCOMP_SANITIZE OR NOT FLEXCOMP_TEST_ONCE)
    flexcomp_unity_test(${ARGV})
  endif()
endfunction()

# One Unity program: test_<name>.cpp or .c, with the libraries that it takes.
function(flexcomp_unity_test name)
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME folder)
  set(target test_${folder}_${name})
  file(GLOB source test_${name}.c test_${name}.cpp)
  add_executable(${target} ${source})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${target} PRIVATE
    FLEXCOMP_ROBOTS="${PROJECT_SOURCE_DIR}/host/robots"
    FLEXCOMP_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data"
    FLEXCOMP_FEW_CASES=$<OR:$<BOOL:${FLEXCOMP_SANITIZE}>,$<BOOL:${CMAKE_CROSSCOMPILING}>>)
  target_link_libraries(${target} PRIVATE flexcomp_flags flexcomp_unity ${ARGN})
  if(TARGET flexcomp_semihosting)
    target_link_libraries(${target} PRIVATE flexcomp_start_up flexcomp_semihosting)
  endif()
  add_test(NAME ${folder}.${name} COMMAND ${target})
  set_tests_properties(${folder}.${name} PROPERTIES TIMEOUT 300 ENVIRONMENT "${sanitizer_options}")
endfunction()

string(JOIN ";" python_environment
  FLEXCOMP_SOURCE=${PROJECT_SOURCE_DIR}
  FLEXCOMP_BUILD=${PROJECT_BINARY_DIR}
  FLEXCOMP_BUILD_TYPE=${CMAKE_BUILD_TYPE}
  FLEXCOMP_SANITIZED=${FLEXCOMP_SANITIZE}
  FLEXCOMP_CORE=$<TARGET_FILE:flexcomp_core>
  FLEXCOMP_CLIENT=$<$<TARGET_EXISTS:flexcomp_client>:$<TARGET_FILE:flexcomp_client>>
  FLEXCOMP_EIGEN=$<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>
  FLEXCOMP_C=${CMAKE_C_COMPILER}
  FLEXCOMP_CXX=${CMAKE_CXX_COMPILER}
  PYTHONDONTWRITEBYTECODE=1
  ${sanitizer_options})

# With cantools and python-can in it.
set(bus_python ${PROJECT_SOURCE_DIR}/build/third_party/python/bin/python)

# One Python program that drives processes: test_<name>.py. A second argument is the interpreter, where the
# test needs packages. They take longest: ctest starts them first, and short ones fill the end.
function(flexcomp_python_test name)
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME folder)
  set(python ${ARGV1})
  if(NOT python)
    set(python ${Python3_EXECUTABLE})
  endif()
  add_test(NAME ${folder}.${name} COMMAND ${python} ${CMAKE_CURRENT_SOURCE_DIR}/test_${name}.py)
  set_tests_properties(${folder}.${name} PROPERTIES
    TIMEOUT 300 COST 10
    ENVIRONMENT "FLEXCOMP_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};${python_environment}")
endfunction()

# flexcomp_bus_test(name command…): where there is a CAN bus, in a guest with a patient clock (tools/vcan). So it
# holds on a busy machine, and what it waits for takes no time.
function(flexcomp_bus_test name)
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME folder)
  add_test(NAME ${folder}.${name} COMMAND ${ARGN})
  set_tests_properties(${folder}.${name} PROPERTIES
    TIMEOUT 400 COST 20 LABELS bus
    ENVIRONMENT "FLEXCOMP_VCAN=guest;FLEXCOMP_GUEST_PATIENCE=20;FLEXCOMP_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};${python_environment}")
endfunction()
