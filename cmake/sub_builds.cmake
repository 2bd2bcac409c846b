# The sanitized copy of the tree: built with this one, by the preset that people use for it, and its tests (named
# sanitized.*) run by this one's ctest.
set(sanitized ${PROJECT_BINARY_DIR}/sanitized)

# As many jobs as cores, besides what is left of the outer build's: the copy is most of what is compiled, and alone at the
# end. More would only compete: five compilers on two cores took 12 % more processor time than two.
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)

add_custom_target(sanitized ALL
  COMMAND ${CMAKE_COMMAND} --preset sanitize -S ${PROJECT_SOURCE_DIR} -B ${sanitized}
          -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} --log-level=WARNING
  COMMAND ${CMAKE_COMMAND} --build ${sanitized} --parallel ${cores}
  WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} USES_TERMINAL VERBATIM)

# A copy that was not built is a test that fails, not fewer tests.
file(WRITE ${PROJECT_BINARY_DIR}/sanitized_tests.cmake
"if(EXISTS \"${sanitized}/CTestTestfile.cmake\")
  subdirs(\"${sanitized}\")
else()
  add_test(sanitized.NOT_BUILT NOT_BUILT)
endif()
")
set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${PROJECT_BINARY_DIR}/sanitized_tests.cmake)
