# For a machine that builds everything once and keeps nothing (CI): others' headers are read once, which saves a third of the work. Off
# otherwise: ccache does more, and each file shows that it includes what it uses.

option(CGSR_PRECOMPILE "precompile others' headers" OFF)

# cgsr_precompile(): every target below the current folder that is compiled in the same C++ reads the precompiled header that fits it: of a
# test, of an unoptimised test, of a part of a plug-in (-fPIC), or of anything else.
function(cgsr_precompile)
  foreach(for IN ITEMS precompiled precompiled_pic precompiled_test precompiled_unoptimized_test)
    add_library(cgsr_${for} STATIC ${CMAKE_SOURCE_DIR}/cmake/precompiled.cpp)
    target_include_directories(cgsr_${for} PRIVATE ${OpenCV_INCLUDE_DIRS})
    target_link_libraries(cgsr_${for} PRIVATE tl::expected fmt::fmt Eigen3::Eigen)
    target_precompile_headers(cgsr_${for} PRIVATE ${CMAKE_SOURCE_DIR}/cmake/precompiled.h)
  endforeach()
  set_target_properties(cgsr_precompiled_pic PROPERTIES POSITION_INDEPENDENT_CODE ON)
  foreach(for IN ITEMS precompiled_test precompiled_unoptimized_test)
    target_link_libraries(cgsr_${for} PRIVATE GTest::gmock)
    target_precompile_headers(cgsr_${for} PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
  endforeach()
  target_compile_options(cgsr_precompiled_unoptimized_test PRIVATE $<$<CONFIG:RelWithDebInfo>:-O0>)
  cgsr_targets_below(${CMAKE_SOURCE_DIR} targets)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(pic ${target} POSITION_INDEPENDENT_CODE)
    get_target_property(standard ${target} CXX_STANDARD)
    get_target_property(unoptimized ${target} CGSR_UNOPTIMIZED)
    set(from cgsr_precompiled)
    if(pic)
      set(from cgsr_precompiled_pic)
    elseif(unoptimized)
      set(from cgsr_precompiled_unoptimized_test)
    elseif(target MATCHES "^test_")
      set(from cgsr_precompiled_test)
    endif()
    if(standard EQUAL CMAKE_CXX_STANDARD AND type MATCHES "STATIC_LIBRARY|EXECUTABLE" AND NOT target MATCHES "^cgsr_precompiled")
      target_link_libraries(${target} PRIVATE fmt::fmt)  # whose definitions the precompiled header saw
      target_precompile_headers(${target} REUSE_FROM ${from})
      # g++ 12 warns of its own std::string once its headers are not read in place. The release without this warns where it should. And it need
      # not tidy up its memory as often as it does.
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
                             "SHELL:--param ggc-min-heapsize=600000")
    endif()
  endforeach()
endfunction()
