# For a machine that builds everything once and keeps nothing (CI): others' headers are read once, which saves a third of the work. Off
# otherwise: ccache does more, and each file shows that it includes what it uses.

option(CGSR_PRECOMPILE "precompile others' headers" OFF)

# cgsr_precompile(): every target below the current folder that is compiled like the precompiled header, without -fPIC and in the same C++.
function(cgsr_precompile)
  add_library(cgsr_precompiled STATIC ${CMAKE_SOURCE_DIR}/cmake/precompiled.cpp)
  target_include_directories(cgsr_precompiled PRIVATE ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(cgsr_precompiled PRIVATE tl::expected fmt::fmt Eigen3::Eigen nlohmann_json::nlohmann_json opencv_imgproc opencv_imgcodecs GTest::gmock)
  target_precompile_headers(cgsr_precompiled PRIVATE ${CMAKE_SOURCE_DIR}/cmake/precompiled.h)
  cgsr_targets_below(${CMAKE_SOURCE_DIR} targets)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(pic ${target} POSITION_INDEPENDENT_CODE)
    get_target_property(standard ${target} CXX_STANDARD)
    if(NOT pic AND standard EQUAL CMAKE_CXX_STANDARD AND type MATCHES "STATIC_LIBRARY|EXECUTABLE" AND NOT target STREQUAL cgsr_precompiled)
      target_precompile_headers(${target} REUSE_FROM cgsr_precompiled)
      # g++ 12 warns of its own std::string once its headers are not read in place. The release without this warns where it should.
      target_compile_options(${target} PRIVATE -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread)
    endif()
  endforeach()
endfunction()

function(cgsr_targets_below folder out)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(sub IN LISTS folders)
    cgsr_targets_below(${sub} more)
    list(APPEND targets ${more})
  endforeach()
  set(${out} ${targets} PARENT_SCOPE)
endfunction()
