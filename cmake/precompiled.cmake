# Parses the common headers once for all libraries and once for all tests: a build from nothing is a good third shorter. Off where people work,
# because ccache knows a file better without it and a missing #include would stay hidden.
option(CGSR_PRECOMPILE "precompile the headers that most files include (for a machine that builds once)" OFF)

if(CGSR_PRECOMPILE)
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp "")
  add_library(cgsr_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  set_target_properties(cgsr_precompiled PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(cgsr_precompiled PRIVATE Eigen3::Eigen fmt::fmt tl::expected opencv_core)
  target_precompile_headers(cgsr_precompiled PRIVATE ${CMAKE_SOURCE_DIR}/cmake/precompiled.h)

  add_library(cgsr_precompiled_test OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(cgsr_precompiled_test PRIVATE Eigen3::Eigen fmt::fmt tl::expected opencv_core GTest::gmock GTest::gtest)
  target_precompile_headers(cgsr_precompiled_test PRIVATE ${CMAKE_SOURCE_DIR}/cmake/precompiled.h <gmock/gmock.h> <gtest/gtest.h>)
endif()

function(cgsr_reuse_precompiled target from)
  if(CGSR_PRECOMPILE)
    get_target_property(relocatable ${from} POSITION_INDEPENDENT_CODE)  # it has to be the same for all that share the headers
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${relocatable})
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()
