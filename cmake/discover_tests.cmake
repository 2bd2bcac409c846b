# Registers every CppUTest test of an executable with CTest, by asking the built executable for its list
# (CppUTest's own module overwrites CTestTestfile.cmake, so one executable a folder would be its limit).
# Doubles as the script that runs after each build: cmake -DEXECUTABLE=.. -DOUTPUT=.. -DPREFIX=.. -P.

# strainfinger_discover_tests(TARGET PREFIX [REPORT command...] [PROPERTIES name value...])
# With REPORT, the tests are run elsewhere and `command... Group.Test` tells what became of one.
# Under sanitizers a group is one test of CTest's: 2,000 processes would spend minutes on starting.
function(strainfinger_discover_tests target prefix)
  cmake_parse_arguments(DISCOVER "" "" "REPORT;PROPERTIES" ${ARGN})
  set(list ${CMAKE_CURRENT_BINARY_DIR}/${target}_tests.cmake)
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DEXECUTABLE=$<TARGET_FILE:${target}> -DOUTPUT=${list} -DPREFIX=${prefix}
            "-DREPORT=${DISCOVER_REPORT}" "-DPROPERTIES=${DISCOVER_PROPERTIES}"
            -DBY_GROUP=$<BOOL:${STRAINFINGER_SANITIZE}>
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
  if(BY_GROUP)
    list(TRANSFORM names REPLACE "\\..*" "")
    list(REMOVE_DUPLICATES names)
  endif()
  list(JOIN REPORT "\" \"" report)
  list(JOIN PROPERTIES "\" \"" properties)
  set(content "")
  foreach(name IN LISTS names)
    if(REPORT)
      set(command "\"${report}\" ${name}")
    else()
      string(REPLACE "." " -sn " which ${name})
      set(command "\"${EXECUTABLE}\" -v -sg ${which}")
    endif()
    string(APPEND content "add_test(\"${PREFIX}.${name}\" ${command})\n")
    if(PROPERTIES)
      string(APPEND content "set_tests_properties(\"${PREFIX}.${name}\" PROPERTIES \"${properties}\")\n")
    endif()
  endforeach()
  file(WRITE ${OUTPUT} "${content}")
endif()
