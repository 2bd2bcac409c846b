# Registers every CppUTest test of an executable with CTest, by asking the built executable for its list
# (CppUTest's own module overwrites CTestTestfile.cmake, so one executable a folder would be its limit).
# Doubles as the script that runs after each build: cmake -DEXECUTABLE=.. -DOUTPUT=.. -DPREFIX=.. -P.

function(strainfinger_discover_tests target prefix)
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_tests.cmake)
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DEXECUTABLE=$<TARGET_FILE:${target}> -DOUTPUT=${list} -DPREFIX=${prefix}
            -P ${PROJECT_SOURCE_DIR}/cmake/discover_tests.cmake
    BYPRODUCTS ${list} VERBATIM)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${list})
endfunction()

if(CMAKE_SCRIPT_MODE_FILE AND DEFINED EXECUTABLE)
  execute_process(COMMAND ${EXECUTABLE} -ln OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(names)
  if(NOT names)
    message(FATAL_ERROR "${EXECUTABLE} lists no tests")
  endif()
  set(content "")
  foreach(name IN LISTS names)
    string(REPLACE "." ";" parts ${name})
    list(GET parts 0 group)
    list(GET parts 1 test)
    string(APPEND content "add_test(\"${PREFIX}.${name}\" \"${EXECUTABLE}\" -v -sg ${group} -sn ${test})\n")
  endforeach()
  file(WRITE ${OUTPUT} "${content}")
endif()
