// The walk of rays through the ellipsoids of their cloud, by itself.
//   bench_free_space CLOUD.ply [THREADS]
// Prints a line on what making the ellipsoids takes, counting ends in them, and walking all rays, and one on
// merging the cloud's two halves, of every other ray.

#include "cloud_ellipsoids.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/ray_cloud_file.h>
#include <raycloud/volume/free_space.h>
#include <raycloud/volume/merge_clouds.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

struct Instant {
  double wall = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  double processor = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
};

/// `work(chunk)` for all rays, in pieces.
template <class Work>
void each_piece(const ray::Context& context, const ray::RayCloud& rays, const Work& work) {
  constexpr std::size_t kRays = 1 << 15;
  ray::parallel_for(context, rays.size(), kRays, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> rows;
    for (std::size_t i = begin; i < end; ++i)
      rows.push_back(static_cast<std::uint32_t>(i));
    ray::RayCloud piece;
    piece.assign_rows(rays, rows);
    work(piece);
  });
}

/// Keeps nothing.
class NoSink final : public ray::RaySink {
 public:
  void encode(const ray::RayCloud& /*rays*/, ray::RawChunk& /*raw*/) const override {}
  void write(const ray::RawChunk& /*raw*/) override {}
  void finish() override {}
};

void print_merge(const ray::Context& context, const ray::RayCloud& rays) {
  std::array<ray::RayCloud, 2> halves;
  for (std::size_t half = 0; half < halves.size(); ++half) {
    std::vector<std::uint32_t> rows;
    for (std::size_t i = half; i < rays.size(); i += halves.size())
      rows.push_back(static_cast<std::uint32_t>(i));
    halves[half].assign_rows(rays, rows);
  }
  ray::MemorySource first(halves[0]), second(halves[1]);
  const std::array<ray::RaySource*, 2> clouds{&first, &second};
  NoSink combined, differences;
  const Instant begun;
  merge_clouds(context, clouds, combined, &differences, {.merge = ray::CloudMerge::min});
  const Instant merged;
  const auto count = static_cast<double>(rays.size());
  const double wall = merged.wall - begun.wall, processor = merged.processor - begun.processor;
  std::printf(
      "Merge by min, %.2f M rays in two clouds: %.2f s (%.2f µs of one core a ray), %.2f M rays/s (bar 0.5)\n",
      count / 1e6, wall, 1e6 * processor / count, count / wall / 1e6);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: bench_free_space CLOUD.ply [THREADS]\n");
    return 2;
  }
  const ray::Context context{.threads = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 0};
  const auto source = ray::open_ray_cloud(argv[1]);
  const ray::RayCloud rays = read_all(context, *source);
  const Instant begun;
  const ray::EllipsoidTree tree = bench::ellipsoids_of(context, rays, {});
  const Instant made;
  std::vector<ray::Evidence> evidence(tree.size());
  const ray::TimeScale scale(rays.times.front(), rays.times.back());
  ray::HitTimes times(tree.size());
  each_piece(context, rays, [&](const ray::RayCloud& piece) { times.add(tree, piece, scale); });
  times.find_episodes(context, scale.ticks(0.5), evidence);
  const Instant counted;
  each_piece(context, rays,
             [&](const ray::RayCloud& piece) { add_passes(tree, piece, {}, scale, evidence); });
  const Instant walked;
  const auto count = static_cast<double>(rays.size());
  const auto spent = [&](const Instant& from, const Instant& to) {
    std::printf(" %.2f s (%.2f µs of one core a ray),", to.wall - from.wall,
                1e6 * (to.processor - from.processor) / count);
  };
  std::printf("\nFree space, %.2f M rays: ellipsoids", count / 1e6);
  spent(begun, made);
  std::printf(" ends");
  spent(made, counted);
  std::printf(" walk");
  spent(counted, walked);
  std::printf(" %.2f M rays/s (bar 2)\n", count / (walked.wall - counted.wall) / 1e6);
  print_merge(context, rays);
  return 0;
}
