# One folder is one static library: cgsr_library(NAME sources… DEPENDS targets…). The dependencies named here are the arrows of
# docs/architecture.md; tools/check_layers.py holds the #include lines to the same arrows.

function(cgsr_library name)
  cmake_parse_arguments(ARG "" "" "DEPENDS" ${ARGN})
  add_library(cgsr_${name} STATIC ${ARG_UNPARSED_ARGUMENTS})
  target_include_directories(cgsr_${name} PUBLIC ${CMAKE_SOURCE_DIR})
  target_link_libraries(cgsr_${name} PUBLIC tl::expected fmt::fmt ${ARG_DEPENDS})
endfunction()

# cgsr_kernels(sources…): loops over arrays that the compiler may vectorise in the release; everything else stays at -O2.
function(cgsr_kernels)
  set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:RelWithDebInfo>:-O3>" SKIP_PRECOMPILE_HEADERS ON)
endfunction()

# cgsr_test(NAME sources… DEPENDS targets… [LABEL …]): one test program per folder, each TEST() a ctest of its own. LABEL: unit (default), sim,
# app, or slow, which only tools/test --long runs; SLOW: the tests of that name alone (gtest's filter). UNOPTIMIZED: the test itself computes little, so compiling it quickly counts for more; what it
# tests is optimised all the same.
function(cgsr_test name)
  cmake_parse_arguments(ARG "UNOPTIMIZED" "TIMEOUT;LABEL;SLOW" "DEPENDS" ${ARGN})
  if(NOT ARG_LABEL)
    set(ARG_LABEL unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_executable(test_${name} ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(test_${name} PRIVATE ${ARG_DEPENDS} GTest::gmock GTest::gtest_main)
  if(ARG_UNOPTIMIZED)
    target_compile_options(test_${name} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O0>)
    set_target_properties(test_${name} PROPERTIES CGSR_UNOPTIMIZED ON)
  endif()
  set(filter "")
  if(ARG_SLOW)
    set(filter TEST_FILTER -${ARG_SLOW})
    gtest_discover_tests(test_${name} TEST_PREFIX ${name}: TEST_LIST ${name}_slow TEST_FILTER ${ARG_SLOW} DISCOVERY_MODE PRE_TEST
                         DISCOVERY_TIMEOUT 120 PROPERTIES LABELS slow TIMEOUT ${ARG_TIMEOUT} SKIP_REGULAR_EXPRESSION "SKIPPED")
  endif()
  gtest_discover_tests(test_${name} TEST_PREFIX ${name}: ${filter} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 120
                       PROPERTIES LABELS "${ARG_LABEL}" TIMEOUT ${ARG_TIMEOUT} SKIP_REGULAR_EXPRESSION "SKIPPED")
endfunction()
include(GoogleTest)
