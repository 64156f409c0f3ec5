# One static library per module: a wrong include fails to link.

add_library(tsubu_options INTERFACE)
target_include_directories(tsubu_options INTERFACE "${PROJECT_SOURCE_DIR}/src")
# Contraction off and no fast-math: the same scene gives the same bits with every compiler and instruction set.
# errno and trapping semantics are not part of the results; without them square roots and selects vectorise.
target_compile_options(tsubu_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
# At -O3 g++ 12 takes the strings of a temporary for uninitialized; clang and the sanitizers look after the real ones.
target_compile_options(tsubu_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
if(TSUBU_WERROR)
  target_compile_options(tsubu_options INTERFACE -Werror)
endif()
if(TSUBU_SANITIZE)
  target_compile_options(tsubu_options INTERFACE -fsanitize=${TSUBU_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(tsubu_options INTERFACE -fsanitize=${TSUBU_SANITIZE})
endif()

# tsubu_module(name SOURCES … USES … PRIVATE_LIBRARIES … PUBLIC_LIBRARIES …)
function(tsubu_module name)
  cmake_parse_arguments(M "" "" "SOURCES;USES;PUBLIC_LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  add_library(tsubu_${name} STATIC ${M_SOURCES})
  target_link_libraries(tsubu_${name} PUBLIC tsubu_options ${M_PUBLIC_LIBRARIES} PRIVATE ${M_PRIVATE_LIBRARIES})
  foreach(other ${M_USES})
    target_link_libraries(tsubu_${name} PUBLIC tsubu_${other})
  endforeach()
endfunction()

# tsubu_test(name SOURCES … USES … LABELS …): one test program per module, one ctest entry per program. The target
# tsubu_unit_tests builds those with the label unit, which is what runs under sanitizers.
add_custom_target(tsubu_unit_tests)
function(tsubu_test name)
  cmake_parse_arguments(T "" "TIMEOUT" "SOURCES;USES;LABELS" ${ARGN})
  add_executable(${name} ${T_SOURCES})
  target_link_libraries(${name} PRIVATE ${T_USES} tsubu_test_support GTest::gtest GTest::gtest_main)
  # Tests are compiled once and run once: -O2 saves a third of the compile time.
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O2>)
  add_test(NAME ${name} COMMAND ${name})
  if("unit" IN_LIST T_LABELS)
    add_dependencies(tsubu_unit_tests ${name})
  endif()
  if(NOT T_TIMEOUT)
    set(T_TIMEOUT 1500)  # for the slowest machine: with sanitizers, and neighbours
  endif()
  # Folders of this build: two checkouts may be tested at once.
  file(MAKE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/files")
  set_tests_properties(${name} PROPERTIES TIMEOUT ${T_TIMEOUT} LABELS "${T_LABELS}"
    ENVIRONMENT "TEST_TMPDIR=${CMAKE_CURRENT_BINARY_DIR}/files/")
endfunction()
