#include "support/random_cloud.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;

/// Thins to every third ray and counts, so that both map and fold matter.
RayCloud run(const RayCloud& cloud, unsigned threads, std::size_t chunk_rays, StreamCounts& counts) {
  MemorySource source(cloud, chunk_rays);
  MemorySink sink(source.info().extras);
  std::uint64_t row = 0;
  counts = stream(
      {.threads = threads}, source, &sink,
      [](RayCloud& rays) {
        rays.transform(translation_pose({1.0, 2.0, 3.0}));
        return rays.size();
      },
      [&](RayCloud& rays, std::size_t& size) {
        std::vector<std::uint8_t> keep(size);
        for (auto& k : keep)
          k = row++ % 3 == 0 ? 1 : 0;
        rays.select(keep);
      });
  sink.finish();
  return sink.cloud();
}

RC_GTEST_PROP(Stream, ResultDependsNeitherOnThreadsNorOnChunks, ()) {
  const RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = *rc::gen::inRange<std::size_t>(0, 300), .extras = test::schema_of_every_type()});
  StreamCounts counts;
  const RayCloud expected = run(cloud, 1, 1000000, counts);
  RC_ASSERT(counts.rays_in == cloud.size());
  RC_ASSERT(counts.rays_out == (cloud.size() + 2) / 3);
  for (const unsigned threads : {1U, 2U, 3U, 8U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000000UL}) {
      StreamCounts again;
      RC_ASSERT(same_bits(run(cloud, threads, chunk, again), expected));
      RC_ASSERT(again.rays_out == counts.rays_out);
    }
  }
}

TEST(ReadAll, GivesTheCloudBack) {
  const RayCloud cloud = random_cloud(5, {.rays = 1000, .extras = test::schema_of_every_type()});
  MemorySource source(cloud, 64);
  EXPECT_TRUE(same_bits(read_all({.threads = 2}, source), cloud));
}

}  // namespace
}  // namespace ray
