# One place for compiler settings that every target of the project shares.
add_library(raycloud_build INTERFACE)
target_compile_options(raycloud_build INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused
  # Options structs are initialised by name; members left out keep their defaults.
  -Wno-missing-field-initializers
  $<$<BOOL:${RAYCLOUD_WERROR}>:-Werror>
  # Results must be the same bits on every build: never fuse a multiplication and an addition.
  -ffp-contract=off)

find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()
