# A room is a folder with one target; the libraries of common, hal, firmware and host are made here, so that all get the
# same warnings and the same include root ("common/fixed.hpp"). What a room may include is in the
# README.md of the folder of rooms, and tests/architecture checks it.

# strainfinger_compile_together(TARGET) (but for files with the property SKIP_UNITY_BUILD_INCLUSION)
# Whoever compiles everything compiles files in batches, which is sooner done: the program in six tenths of the CPU time.
# That every file includes what it needs, the preset `dev` shows. So the files of a room have names of their own even for what only they use.
function(strainfinger_compile_together target)
  if(STRAINFINGER_COMPILE_TOGETHER)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  endif()
endfunction()

# Large batches have much to collect, and GCC does it as if memory were scarce.
if(STRAINFINGER_COMPILE_TOGETHER AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  add_compile_options("SHELL:--param ggc-min-expand=200" "SHELL:--param ggc-min-heapsize=600000")
endif()

# strainfinger_room(NAME [SOURCES file...] [DEPENDS target...])
# Makes strainfinger_NAME (alias strainfinger::NAME); header-only without SOURCES.
function(strainfinger_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS" ${ARGN})
  set(target strainfinger_${name})
  if(ROOM_SOURCES)
    add_library(${target} STATIC ${ROOM_SOURCES})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE strainfinger::warnings)
    strainfinger_compile_together(${target})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} ${PROJECT_SOURCE_DIR})
  target_link_libraries(${target} ${scope} ${ROOM_DEPENDS})
  add_library(strainfinger::${name} ALIAS ${target})
endfunction()
