#pragma once
/// Scans of a scene: every ray goes from the scanner to the first surface, so that occlusion, free space and
/// sky are right by construction.

#include <raycloud/core/ray_stream.h>
#include <raycloud/synth/drift.h>
#include <raycloud/synth/scanner.h>
#include <raycloud/synth/scene.h>

#include <cstdint>
#include <memory>
#include <variant>

namespace ray {

struct SimulationOptions {
  std::uint64_t rays = 1'000'000;  ///< exactly so many
  std::variant<SpinningScanner, StandingScanner> scanner;
  double range = 100.0;    ///< m, above 0, at most 1000; a ray that meets nothing within it is unbounded
  double noise = 0.02;     ///< m, 0 or more; sigma of the range of a bounded ray
  Drift drift;             ///< added to what the scanner writes, starts and ends
  bool truth = false;      ///< the columns below
  std::uint64_t seed = 1;  ///< of the noise
  std::size_t chunk_rays = 32768;
};

/// The scan as a stream, in order of time, that any number of threads may decode at once. Ray `i` depends on
/// `i` alone, so neither threads nor chunks change a bit; memory is that of the SceneCaster whatever the
/// number of rays. About 0.5 µs a ray on one core in a building.
///
/// An unbounded ray ends at `range`, with no noise. The noise is Gaussian along the ray, and no end comes
/// nearer to the sensor than 1 mm. Colours are those of the materials in daylight, the intensity falls with
/// the angle of incidence and the range and is at least 1 for a bounded ray.
///
/// Truth: extra columns `label` (uint8, SceneLabel), `object_id` (int32, -1 for none), `moving` (uint8, 1 for
/// objects that move, come or go), `true_x true_y true_z` (float64, the end without noise and drift), and
/// `normal_x normal_y normal_z` (float32, unit, towards the sensor; 0 for an unbounded ray).
///
/// The scene must outlive the source. Throws Error(usage) for options out of range and for a scene without a
/// path or, with a StandingScanner, without stations; Error(out_of_range) where the memory does not suffice.
[[nodiscard]] std::unique_ptr<RaySource> simulate(const Scene& scene, const SimulationOptions& options);

/// Everything that is ever there as one mesh with the face columns `object_id` (int32) and `label` (uint8);
/// what moves is where its motion begins.
[[nodiscard]] Mesh scene_mesh(const Scene& scene);

}  // namespace ray
