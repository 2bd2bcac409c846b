# `cmake --workflow --preset demo`: the main job, shown. The demo is a shell script, so that it can be read.
add_custom_target(demo
  COMMAND ${PROJECT_SOURCE_DIR}/cmake/demo.sh $<TARGET_FILE:strainfinger_demo> ${PROJECT_BINARY_DIR}/demo
  DEPENDS strainfinger_demo USES_TERMINAL VERBATIM)
