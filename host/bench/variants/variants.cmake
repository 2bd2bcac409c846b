# strainfinger_bench_variants(PREFIX [flag...])
# The locator compiled anew for every rule below, as PREFIX_NAME; PREFIX_variants is all of them.
function(strainfinger_bench_variants prefix)
  add_library(${prefix}_variants INTERFACE)
  macro(strainfinger_bench_rule name)
    strainfinger_bench_variant(${prefix}_${name} ${name} "${ARGN}" ${flags})
    target_link_libraries(${prefix}_variants INTERFACE ${prefix}_${name})
  endmacro()
  set(flags ${ARGN})
  # NAME, then as in step_rule.hpp: a last step's length in eighths of a row spacing, steps, stride of the rows as a power of two
  strainfinger_bench_rule(rows64)              # the firmware's own rule, compiled as the others are
  strainfinger_bench_rule(rows32 10 8 1)       # every second row, and a tolerance to match
  strainfinger_bench_rule(rows16 20 8 2)       # every fourth
  strainfinger_bench_rule(two_rows 16 8 0)     # steps of up to two rows are the last
  strainfinger_bench_rule(one_step 64 1 0)     # the first is, at most an eighth of a pitch as it is
endfunction()

# strainfinger_bench_variant(TARGET NAME RULE [flag...]): RULE is empty or a list as above.
function(strainfinger_bench_variant target name rule)
  set(folder ${PROJECT_SOURCE_DIR}/host/bench/variants)
  set(sources scan whole_scan answer near_fit triple_fit doubt tangent locate)
  list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/firmware/core/)
  list(TRANSFORM sources APPEND .cpp)
  add_library(${target} STATIC EXCLUDE_FROM_ALL ${folder}/locate_into.cpp ${sources})
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON)
  if(rule)
    list(GET rule 0 CONVERGED_EIGHTHS)
    list(GET rule 1 MOST_STEPS)
    list(GET rule 2 ROW_STRIDE_BITS)
    set(headers ${CMAKE_CURRENT_BINARY_DIR}/variants/${name})
    configure_file(${folder}/step_rule.hpp.in ${headers}/firmware/core/step_rule.hpp @ONLY)
    target_include_directories(${target} BEFORE PRIVATE ${headers})
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_definitions(${target} PRIVATE strainfinger=strainfinger_${name})
  target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti ${ARGN})
  target_link_libraries(${target} PRIVATE strainfinger::warnings)
endfunction()
