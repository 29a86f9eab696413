#pragma once
/// Runs ways of decimation in every way that must not matter.

#include "support/random_cloud.h"

#include <raycloud/core/error.h>
#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace ray::test {

/// Runs `decimate(context, source, sink)` and returns what came out.
template <class Decimate>
RayCloud thinned(const RayCloud& cloud, const Context& context, std::size_t chunk_rays,
                 const Decimate& decimate) {
  MemorySource source(cloud, chunk_rays);
  MemorySink sink(source.info().extras);
  const StreamCounts counts = decimate(context, source, sink);
  EXPECT_EQ(counts.rays_in + counts.dropped, cloud.size());
  EXPECT_EQ(counts.rays_out, sink.cloud().size());
  return sink.cloud();
}

/// Whatever the threads, the chunks and the memory, which is first plenty, then too little for all or all but
/// nothing.
template <class Decimate>
void expect_however_it_runs(const RayCloud& cloud, const RayCloud& expected, const Decimate& decimate) {
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      RC_ASSERT(same_bits(thinned(cloud, {.threads = threads}, chunk, decimate), expected));
    }
  }
  const auto threads = *rc::gen::element(1U, 2U, 8U);
  const auto chunk = *rc::gen::element<std::size_t>(7, 50, 1000);
  const auto memory = *rc::gen::element<std::size_t>(1, 20000, 40000, 80000, 160000);
  RC_ASSERT(same_bits(thinned(cloud, {.threads = threads, .memory = memory}, chunk, decimate), expected));
}

/// Of the error that `decimate(context, source, sink)` throws.
template <class Decimate>
ErrorCode code_of(const Decimate& decimate) {
  const RayCloud cloud = random_cloud(3, {.rays = 4});
  MemorySource source(cloud);
  MemorySink sink;
  try {
    decimate(Context{}, source, sink);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::cancelled;
}

}  // namespace ray::test
