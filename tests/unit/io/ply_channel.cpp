// What goes through a channel must be what goes through a file.
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/ply_channel.h>
#include <raycloud/io/ply_cloud.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <thread>

namespace ray {
namespace {

using test::random_cloud;
using test::same_bits;
using test::Scratch;

void send(const RayCloud& cloud, RaySink& sink, std::size_t chunk_rays, unsigned threads = 1) {
  MemorySource source(cloud, chunk_rays);
  static_cast<void>(stream_each({.threads = threads}, source, sink, [](RayCloud&) {}));
  sink.finish();
}

struct Received {
  CloudInfo info;
  RayCloud rays;
};

Received through_channel(const RayCloud& cloud, const CloudInfo& info, std::size_t chunk_rays,
                         unsigned threads) {
  PlyChannel channel = make_ply_channel(info);
  std::thread writer([&] { send(cloud, *channel.sink, chunk_rays, threads); });
  Received received{channel.source->info(), read_all({.threads = threads}, *channel.source)};
  writer.join();
  return received;
}

RC_GTEST_PROP(PlyChannel, IsAFileThatIsNotThere, ()) {
  const Scratch scratch;
  const auto precision = *rc::gen::element(Precision::single, Precision::double_);
  RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = *rc::gen::inRange<std::size_t>(0, 300), .extras = test::schema_of_every_type()});
  CloudInfo info{.precision = precision,
                 .coordinate_step = 0.0001,
                 .extras = test::schema_of_every_type(),
                 .crs = "EPSG:7845",
                 .time_base = "gps_week",
                 .history = {"raydecimate 4 cm"},
                 .comments = {"by hand", "origin 1 2 3"}};
  const auto path = scratch.path("cloud.ply");
  const auto file = create_ply(path, info);
  send(cloud, *file, 1000);
  const auto back = open_ply(path);
  const RayCloud expected = read_all({}, *back);
  for (const unsigned threads : {1U, 3U}) {
    for (const std::size_t chunk : {1UL, 7UL, 1000UL}) {
      const Received received = through_channel(cloud, info, chunk, threads);
      RC_ASSERT(same_bits(received.rays, expected));
      RC_ASSERT(received.info.precision == back->info().precision);
      RC_ASSERT(received.info.coordinate_step == back->info().coordinate_step);
      RC_ASSERT(received.info.extras == back->info().extras);
      RC_ASSERT(received.info.crs == back->info().crs);
      RC_ASSERT(received.info.time_base == back->info().time_base);
      RC_ASSERT(received.info.history == back->info().history);
      RC_ASSERT(received.info.comments == back->info().comments);
      RC_ASSERT(!received.info.ray_count);
    }
  }
}

RC_GTEST_PROP(PlyMirror, ShowsWhatAFileWouldGiveBack, ()) {
  const Scratch scratch;
  RayCloud cloud =
      random_cloud(*rc::gen::arbitrary<std::uint64_t>(),
                   {.rays = *rc::gen::inRange<std::size_t>(0, 1500), .extras = test::schema_of_every_type()});
  for (std::size_t i = 0; i < cloud.size(); i += 3)
    cloud.colours[i].intensity = 0;
  const CloudInfo info{.precision = *rc::gen::element(Precision::single, Precision::double_),
                       .coordinate_step = 0.0001,
                       .extras = test::schema_of_every_type(),
                       .history = {"raydecimate 4 cm"}};
  const auto path = scratch.path("cloud.ply");
  const auto file = create_ply(path, info);
  send(cloud, *file, 1000);
  const auto back = open_ply(path);
  const RayCloud expected = read_all({}, *back);
  const PlyMirror mirror(info);
  mirror.reflect(cloud);
  RC_ASSERT(same_bits(cloud, expected));
  RC_ASSERT(mirror.info().extras == back->info().extras);
  RC_ASSERT(mirror.info().history == back->info().history);
  RC_ASSERT(mirror.info().precision == back->info().precision);
  RC_ASSERT(mirror.info().coordinate_step == back->info().coordinate_step);
}

/// Rays of a micrometre far from the origin may change with each rounding; a mirror that calls a cloud
/// settled must be right, for a file of its own precision and for one of double.
RC_GTEST_PROP(PlyMirror, CallsSettledOnlyWhatStaysAsItIs, ()) {
  const bool tiny = *rc::gen::arbitrary<bool>();
  RayCloud cloud = random_cloud(*rc::gen::arbitrary<std::uint64_t>(), {.rays = 200, .half_extent = 300.0});
  for (std::size_t i = 0; tiny && i < cloud.size(); ++i)
    cloud.starts[i] = cloud.ends[i] + 1e-8 * (cloud.starts[i] - cloud.ends[i]);
  const Precision precision = *rc::gen::element(Precision::single, Precision::double_);
  const PlyMirror mirror({.precision = precision});
  const bool settled = mirror.reflect(cloud);
  RC_ASSERT(settled || tiny);
  if (!settled) return;
  for (const Precision next : {precision, Precision::double_}) {
    RayCloud whole = cloud;
    for (std::size_t i = 0; i < whole.size(); i += 3)
      whole.colours[i].intensity = 0;
    RayCloud quick = whole;
    const PlyMirror again({.precision = next});
    RC_ASSERT(again.reflect(whole));
    again.reflect_settled(quick);
    RC_ASSERT(same_bits(whole, quick));
    RC_ASSERT(whole.starts == cloud.starts);
    RC_ASSERT(whole.ends == cloud.ends);
  }
}

ErrorCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorCode::usage;
}

TEST(PlyChannel, AReaderThatGoesStopsTheWriter) {
  PlyChannel channel = make_ply_channel({});
  const RayCloud cloud = random_cloud(1, {.rays = 1000});
  std::thread reader([&] {
    RawChunk raw;
    EXPECT_TRUE(channel.source->fetch(raw));
    channel.source.reset();
  });
  EXPECT_EQ(code_of([&] { send(cloud, *channel.sink, 1); }), ErrorCode::cancelled);
  reader.join();
}

TEST(PlyChannel, AWriterThatFailsStopsTheReader) {
  PlyChannel channel = make_ply_channel({});
  const RayCloud cloud = random_cloud(1, {.rays = 3});
  RawChunk raw;
  channel.sink->encode(cloud, raw);
  channel.sink->write(raw);
  channel.sink.reset();
  RawChunk got;
  EXPECT_TRUE(channel.source->fetch(got));
  EXPECT_EQ(got.rows, 3U);
  EXPECT_EQ(code_of([&] { static_cast<void>(channel.source->fetch(got)); }), ErrorCode::cancelled);
}

TEST(PlyChannel, IsReadOnce) {
  PlyChannel channel = make_ply_channel({});
  channel.source->rewind();
  channel.sink->finish();
  RawChunk raw;
  EXPECT_FALSE(channel.source->fetch(raw));
  EXPECT_THROW(channel.source->rewind(), CannotRewind);
}

TEST(PlyChannel, SinglePrecisionIsRefusedWhereAFileWouldRefuseIt) {
  PlyChannel channel = make_ply_channel({.precision = Precision::single});
  RayCloud cloud = random_cloud(1, {.rays = 1});
  cloud.ends[0].x() = 6900000.123;
  RawChunk raw;
  EXPECT_THROW(channel.sink->encode(cloud, raw), PrecisionLoss);
  EXPECT_THROW(PlyMirror({.precision = Precision::single}).reflect(cloud), PrecisionLoss);
}

}  // namespace
}  // namespace ray
