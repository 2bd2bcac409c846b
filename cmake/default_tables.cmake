# The default finger's tables for images: strainfinger_default_tables, whose default_tables.hpp defines
# strainfinger::kDefaultTableBytes. They are made by the host's program: this build's own, and in a cross build the one
# named by STRAINFINGER_PROGRAM, else one that is built for it here (preset `host`, in this build's folder).
set(STRAINFINGER_PROGRAM "" CACHE FILEPATH "The strainfinger program that makes the default tables; built when empty")

set(program ${STRAINFINGER_PROGRAM})
if(NOT CMAKE_CROSSCOMPILING)
  set(program strainfinger_demo)
  if(STRAINFINGER_WHOLE)
    set(program strainfinger)
  endif()
elseif(NOT program)
  set(host ${PROJECT_BINARY_DIR}/host)
  set(program ${host}/strainfinger)
  add_custom_command(OUTPUT ${program}
    COMMAND ${CMAKE_COMMAND} --preset host -S ${PROJECT_SOURCE_DIR} -B ${host} --log-level=WARNING
    COMMAND ${CMAKE_COMMAND} --build ${host} --target strainfinger --parallel 2
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} USES_TERMINAL VERBATIM
    COMMENT "Building the host's program, which makes the default tables")
endif()

set(folder ${PROJECT_BINARY_DIR}/default_tables)
add_custom_command(OUTPUT ${folder}/default_tables.hpp
  COMMAND ${program} tables --header ${folder}/default_tables.hpp -o ${folder}/default_tables.bin
  DEPENDS ${program} BYPRODUCTS ${folder}/default_tables.bin VERBATIM COMMENT "Making the default tables")
file(MAKE_DIRECTORY ${folder})
add_custom_target(strainfinger_default_tables_header DEPENDS ${folder}/default_tables.hpp)
add_library(strainfinger_default_tables INTERFACE)
target_include_directories(strainfinger_default_tables INTERFACE ${folder})
add_dependencies(strainfinger_default_tables strainfinger_default_tables_header)
add_library(strainfinger::default_tables ALIAS strainfinger_default_tables)
