# One interface target carries the flags of every target of ours. All link it privately: flags are no part of an interface.
add_library(catchlight_options INTERFACE)
# No contraction: the same source gives the same bytes whether or not the compiler may fuse multiply-adds.
target_compile_options(catchlight_options INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -ffp-contract=off)
if(CATCHLIGHT_WERROR)
  target_compile_options(catchlight_options INTERFACE -Werror)
endif()
if(CATCHLIGHT_SANITIZE)
  # The tests' own sources have the property UNINSTRUMENTED: the sanitizers watch what is tested, and tests compile a third faster.
  # GCC's own instrumentation makes it see uninitialised values that are none.
  set(uninstrumented $<BOOL:$<TARGET_PROPERTY:UNINSTRUMENTED>>)
  target_compile_options(catchlight_options INTERFACE
    "$<$<NOT:${uninstrumented}>:-fsanitize=address,undefined;-fno-sanitize-recover=undefined;-fno-omit-frame-pointer;-Wno-maybe-uninitialized>")
  target_link_options(catchlight_options INTERFACE -fsanitize=address,undefined)
endif()
if(CATCHLIGHT_COVERAGE)
  target_compile_options(catchlight_options INTERFACE --coverage -O0)
  target_link_options(catchlight_options INTERFACE --coverage)
endif()

add_library(catchlight_headers OBJECT ${PROJECT_SOURCE_DIR}/cmake/headers.cpp)
target_link_libraries(catchlight_headers PRIVATE catchlight_options glm::glm)
target_include_directories(catchlight_headers PRIVATE ${PROJECT_SOURCE_DIR})
target_precompile_headers(catchlight_headers PRIVATE ${PROJECT_SOURCE_DIR}/cmake/headers.hpp)
