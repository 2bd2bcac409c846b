# Registers every CppUTest test of an executable with CTest, by asking the built executable for its list
# (CppUTest's own module overwrites CTestTestfile.cmake, so one executable a folder would be its limit).
# Doubles as the script that runs after each build: cmake -DEXECUTABLE=.. -DOUTPUT=.. -DPREFIX=.. -P.

# strainfinger_discover_tests(TARGET PREFIX [REPORT command...] [PROPERTIES name value...])
# With REPORT, the tests are run elsewhere and `command... Group.Test` tells what became of one.
function(strainfinger_discover_tests target prefix)
  cmake_parse_arguments(DISCOVER "" "" "REPORT;PROPERTIES" ${ARGN})
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_tests.cmake)
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DEXECUTABLE=$<TARGET_FILE:${target}> -DOUTPUT=${list} -DPREFIX=${prefix}
            "-DREPORT=${DISCOVER_REPORT}" "-DPROPERTIES=${DISCOVER_PROPERTIES}"
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
  list(JOIN REPORT "\" \"" report)
  list(JOIN PROPERTIES "\" \"" properties)
  set(content "")
  foreach(name IN LISTS names)
    string(REPLACE "." ";" parts ${name})
    list(GET parts 0 group)
    list(GET parts 1 test)
    if(REPORT)
      string(APPEND content "add_test(\"${PREFIX}.${name}\" \"${report}\" ${name})\n")
    else()
      string(APPEND content "add_test(\"${PREFIX}.${name}\" \"${EXECUTABLE}\" -v -sg ${group} -sn ${test})\n")
    endif()
    if(PROPERTIES)
      string(APPEND content "set_tests_properties(\"${PREFIX}.${name}\" PROPERTIES \"${properties}\")\n")
    endif()
  endforeach()
  file(WRITE ${OUTPUT} "${content}")
endif()
