# The headers that nearly every file includes, compiled once for all targets with the same flags: two thirds of the
# time of a build would go into reading Eigen, GoogleTest and RapidCheck again and again. Only headers of others, so
# that a change of ours recompiles no more than it must. A file still names what it uses: RAYCLOUD_PRECOMPILED=OFF
# must build too (scripts/lint does).
option(RAYCLOUD_PRECOMPILED "Precompile the headers of the standard library, Eigen and the test libraries" ON)

set(RAYCLOUD_COMMON_HEADERS
    <Eigen/Core> <Eigen/Geometry>
    <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <functional> <limits> <map> <memory> <optional>
    <span> <string> <string_view> <utility> <vector>)
set(RAYCLOUD_TEST_HEADERS ${RAYCLOUD_COMMON_HEADERS} <gmock/gmock.h> <gtest/gtest.h> <rapidcheck.h>
    <rapidcheck/gtest.h>)

# raycloud_precompiled(<target> library|program|test): targets of a kind have the same flags and share theirs.
function(raycloud_precompiled target kind)
  if(NOT RAYCLOUD_PRECOMPILED)
    return()
  endif()
  # Those that the fuzzers watch differ.
  if(RAYCLOUD_FUZZ AND target MATCHES "^raycloud_(core|io|cli)$")
    string(PREPEND kind watched_)
  endif()
  get_property(first GLOBAL PROPERTY RAYCLOUD_PRECOMPILED_${kind})
  if(first)
    target_precompile_headers(${target} REUSE_FROM ${first})
    return()
  endif()
  set_property(GLOBAL PROPERTY RAYCLOUD_PRECOMPILED_${kind} ${target})
  if(kind STREQUAL test)
    target_precompile_headers(${target} PRIVATE ${RAYCLOUD_TEST_HEADERS})
  else()
    target_precompile_headers(${target} PRIVATE ${RAYCLOUD_COMMON_HEADERS})
  endif()
endfunction()
