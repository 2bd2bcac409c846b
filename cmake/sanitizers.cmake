# One switch for the whole tree, so that no object is left uninstrumented. The check of virtual tables opens a pipe for
# itself, and stops the program where a test leaves it no descriptors. Programs at a fixed address start in two thirds of the
# time: there are 770,000 relocations fewer, and tests start them a thousand times.
if(STRAINFINGER_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize=vptr -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=address,undefined -no-pie)
endif()

# strainfinger_leave_unsanitized(FILE...): a library's algorithm, or arithmetic in many digits, too slow under the
# sanitizers. Eigen allocates otherwise under them, so it is told to do as the sanitized files do.
function(strainfinger_leave_unsanitized)
  if(STRAINFINGER_SANITIZE)
    set_source_files_properties(${ARGN} PROPERTIES
      COMPILE_OPTIONS -fno-sanitize=all COMPILE_DEFINITIONS EIGEN_MALLOC_ALREADY_ALIGNED=0)
  endif()
endfunction()

# strainfinger_casts_no_pointers(): in this folder and those that it adds from here on, code is compiled without the checks
# that make a fifth of the time to compile it: of null pointers, which the address sanitizer stops when they are used, and
# of alignment and sizes, which code that casts no pointers can't get wrong.
macro(strainfinger_casts_no_pointers)
  if(STRAINFINGER_SANITIZE)
    add_compile_options(-fno-sanitize=null,alignment,object-size)
  endif()
endmacro()
