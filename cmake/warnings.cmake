# The warnings every target of ours is compiled with. They become errors in the presets that test
# (CMAKE_COMPILE_WARNING_AS_ERROR), not for users with another compiler.
add_library(strainfinger_warnings INTERFACE)
add_library(strainfinger::warnings ALIAS strainfinger_warnings)
target_compile_options(strainfinger_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wdouble-promotion -Wshadow -Wold-style-cast
  -Wcast-align -Wundef -Wnon-virtual-dtor -Woverloaded-virtual)
