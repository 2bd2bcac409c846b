# `cmake --build ... --target format` rewrites; the test `format` only looks.
find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
file(GLOB_RECURSE STRAINFINGER_FORMATTED CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/common/*.[ch]pp ${PROJECT_SOURCE_DIR}/hal/*.[ch]pp
  ${PROJECT_SOURCE_DIR}/firmware/*.[ch]pp ${PROJECT_SOURCE_DIR}/host/*.[ch]pp ${PROJECT_SOURCE_DIR}/tests/*.[ch]pp)
if(CLANG_FORMAT)
  add_custom_target(format COMMAND ${CLANG_FORMAT} -i ${STRAINFINGER_FORMATTED} VERBATIM)
endif()
if(STRAINFINGER_TESTS AND NOT STRAINFINGER_SANITIZE)
  add_test(NAME format COMMAND ${CLANG_FORMAT} --dry-run --Werror ${STRAINFINGER_FORMATTED})
endif()
