# For a machine that builds everything from nothing (tools/run, tools/test, CI): several files of a room are compiled as one, which reads
# the headers that they share once. Off otherwise: a change then compiles its own file only, and clang-tidy sees single files.

option(CGSR_UNITY "compile the files of a room in groups" OFF)

# cgsr_unity(): every target below the source folder is compiled in groups (unity_groups.py). Files with compiler options or
# definitions of their own (cgsr_kernels) stay apart: the results are the same bytes as without.
function(cgsr_unity)
  set(lines "")
  cgsr_targets_below(${CMAKE_SOURCE_DIR} targets)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type MATCHES "STATIC_LIBRARY|EXECUTABLE" OR target MATCHES "^cgsr_precompiled")
      continue()
    endif()
    get_target_property(folder ${target} SOURCE_DIR)
    get_target_property(sources ${target} SOURCES)
    foreach(source IN LISTS sources)
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} NORMALIZE)
      get_source_file_property(own_options ${source} TARGET_DIRECTORY ${target} COMPILE_OPTIONS)
      get_source_file_property(own_definitions ${source} TARGET_DIRECTORY ${target} COMPILE_DEFINITIONS)
      if(source MATCHES "\\.cpp$" AND NOT own_options AND NOT own_definitions)
        string(APPEND lines "${target}|${folder}|${source}\n")
      endif()
    endforeach()
  endforeach()

  # A plug-in that takes one function of a group takes all that the group refers to.
  set_target_properties(cgsr_world cgsr_geometry PROPERTIES POSITION_INDEPENDENT_CODE ON)

  set(listed ${CMAKE_BINARY_DIR}/unity_sources.txt)
  file(WRITE ${listed} "${lines}")
  execute_process(COMMAND python3 ${CMAKE_SOURCE_DIR}/cmake/unity_groups.py ${listed} ${CMAKE_BINARY_DIR}/unity
                  OUTPUT_VARIABLE groups COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" groups "${groups}")
  foreach(line IN LISTS groups)
    string(REPLACE "|" ";" line "${line}")
    list(POP_FRONT line target group)
    set_source_files_properties(${line} TARGET_DIRECTORY ${target} PROPERTIES HEADER_FILE_ONLY ON)
    target_sources(${target} PRIVATE ${group})
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)  # a .cpp file that is included looks like a header
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
