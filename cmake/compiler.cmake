# One place for compiler settings that every target of the project shares.
add_library(raycloud_build INTERFACE)
target_compile_options(raycloud_build INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Wunused
  # Options structs are initialised by name; members left out keep their defaults.
  -Wno-missing-field-initializers
  # Functions that take or give vectors of lanes are all inlined; none is called from elsewhere.
  -Wno-psabi
  # GCC sees overlapping copies and unset members inside its own std::string where there are none
  # (GCC bug 105651 and its kin).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-stringop-overread
    -Wno-array-bounds
    # Several files compiled as one have each other's anonymous namespaces.
    -Wno-subobject-linkage>
  $<$<BOOL:${RAYCLOUD_WERROR}>:-Werror>
  # Results must be the same bits on every build: never fuse a multiplication and an addition.
  -ffp-contract=off)

# Paths below the project count as relative, so that one clone profits from what another has compiled.
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
      CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  # Without the time of its making a precompiled header is the same each time.
  add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess> "$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>")
endif()
