// What moved and what stayed: shares kept and removed, on simulated scans.

#include "street_scene.h"
#include "tables.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/exec/stream.h>
#include <raycloud/synth/scenes.h>
#include <raycloud/synth/simulate.h>
#include <raycloud/volume/transients.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace bench {
namespace {

constexpr std::array kNumbers{2.0, 5.0, 10.0, 20.0};
constexpr int kSeenThrough = 20;  // rays, at least, for a moving point to count

struct Judged {
  ray::RayCloud rays;
  std::vector<float> transience;
  std::vector<std::uint16_t> passes;
};

/// The scores, in the order of the rays.
Judged judge(const ray::RayCloud& rays, bool paper) {
  ray::MemorySource source(rays);
  const auto columns = ray::transient_columns(ray::schema_of(rays));
  ray::MemorySink fixed(columns), transient(columns);
  ray::split_transients({}, source, fixed, transient, {.rays = 1e9, .paper = paper});
  fixed.finish();
  Judged judged{fixed.cloud(), {}, {}};
  const auto scores = judged.rays.extra("transience")->values<float>();
  const auto passes = judged.rays.extra("passes")->values<std::uint16_t>();
  judged.transience.assign(scores.begin(), scores.end());
  judged.passes.assign(passes.begin(), passes.end());
  return judged;
}

ray::RayCloud scan(const ray::Scene& scene, std::uint64_t rays, double drift) {
  ray::SimulationOptions options{.rays = rays, .truth = true, .seed = scene.seed};
  if (drift > 0.0)
    options.drift = ray::make_drift({scene.path.times.front(), scene.path.times.back()}, drift, scene.seed);
  return ray::read_all({}, *ray::simulate(scene, options));
}

struct Share {
  double part = 0.0, all = 0.0;
  [[nodiscard]] double percent() const { return all > 0.0 ? 100.0 * part / all : 100.0; }
};

std::string class_of(const ray::Scene& scene, std::uint8_t label, std::int32_t object, bool moving) {
  if (moving && object >= 0 && scene.objects[static_cast<std::size_t>(object)].motion.empty())
    return "parked, then not";
  return std::string(moving ? "moving " : "") + ray::label_name(static_cast<ray::SceneLabel>(label));
}

struct Curve {
  std::array<Share, kNumbers.size()> kept, removed;
  std::map<std::string, std::array<Share, kNumbers.size()>> classes;
};

Curve curve_of(const ray::Scene& scene, const Judged& judged) {
  Curve curve;
  const auto labels = judged.rays.extra("label")->values<std::uint8_t>();
  const auto objects = judged.rays.extra("object_id")->values<std::int32_t>();
  const auto moving = judged.rays.extra("moving")->values<std::uint8_t>();
  for (std::size_t i = 0; i < judged.rays.size(); ++i) {
    if (judged.rays.bounded[i] == 0) continue;
    const bool moves = moving[i] != 0;
    if (moves && judged.passes[i] < kSeenThrough) continue;
    auto& of_class = curve.classes[class_of(scene, labels[i], objects[i], moves)];
    for (std::size_t n = 0; n < kNumbers.size(); ++n) {
      const bool gone = judged.transience[i] > static_cast<float>(kNumbers[n]);
      Share& share = moves ? curve.removed[n] : curve.kept[n];
      const double right = gone == moves ? 1.0 : 0.0;
      share.part += right, share.all += 1.0;
      of_class[n].part += right, of_class[n].all += 1.0;
    }
  }
  return curve;
}

struct Bar {
  double n = 0.0;  ///< 0: none
  double kept = 0.0, removed = 0.0, both = 0.0;
};

void curve_row(const std::string& name, const Curve& curve, const std::vector<Bar>& bars) {
  std::printf("| %s |", name.c_str());
  std::string promised;
  bool met = true;
  for (std::size_t n = 0; n < kNumbers.size(); ++n) {
    const double kept = curve.kept[n].percent(), removed = curve.removed[n].percent();
    const double both = std::sqrt(kept * removed);
    if (curve.removed[n].all > 0.0)
      std::printf(" %.2f, %.2f, %.2f |", kept, removed, both);
    else
      std::printf(" %.2f |", kept);
    for (const Bar& bar : bars) {
      if (bar.n != kNumbers[n]) continue;
      char text[80];
      std::snprintf(text, sizeof text, "n = %.0f: ", bar.n);
      promised += promised.empty() ? text : std::string("; ") + text;
      const auto promise = [&](const char* what, double least, double value) {
        if (least == 0.0) return;
        std::snprintf(text, sizeof text, "%s ≥ %.1f ", what, least);
        promised += text;
        met = met && value >= least;
      };
      promise("SA", bar.kept, kept);
      promise("DA", bar.removed, removed);
      promise("AA", bar.both, both);
    }
  }
  std::printf(" %s |\n", bars.empty() ? " |" : verdict(promised, met).c_str());
  std::fflush(stdout);
}

void class_table(const std::string& name, const Curve& curve) {
  std::printf("\n%s, %% of the points of a class that are rightly kept or removed\n\n| class | points |",
              name.c_str());
  for (const double n : kNumbers)
    std::printf(" n = %.0f |", n);
  std::printf("\n|---|---|---|---|---|---|\n");
  for (const auto& [of, shares] : curve.classes) {
    std::printf("| %s | %.0f |", of.c_str(), shares[0].all);
    for (const Share& share : shares)
      std::printf(" %.2f |", share.percent());
    std::printf("\n");
  }
}

struct Case {
  std::string name;
  ray::Scene scene;
  std::vector<double> drifts{0.0};
  std::uint64_t rays = 600'000;
};

std::vector<Bar> bars_of(const Case& one, double drift) {
  if (one.name == "field") return {};
  if (one.name != "street") return {{2.0, 99.0, 0.0, 0.0}, {10.0, 99.9, 0.0, 0.0}};
  if (drift == 0.01) return {{10.0, 99.5, 97.0, 0.0}};
  if (drift == 0.03) return {{10.0, 0.0, 0.0, 96.0}};
  return {};
}

}  // namespace

void print_transients() {
  const std::vector<Case> cases{{"street", street_scene(7, 12), {0.0, 0.01, 0.03, 0.1}, 1'800'000},
                                {"yard", street_scene(8, 0)},
                                {"building", make_scene(ray::SceneKind::building, 2)},
                                {"forest", make_scene(ray::SceneKind::forest, 2)},
                                {"field", make_scene(ray::SceneKind::field, 2)}};
  std::printf(
      "\nTransients: %% of the static points kept (SA), of the moving points that %d rays went through removed "
      "(DA), and √(SA · DA)\n\n| cloud |",
      kSeenThrough);
  for (const double n : kNumbers)
    std::printf(" n = %.0f |", n);
  std::printf(" bar | |\n|---|---|---|---|---|---|---|\n");
  std::vector<std::pair<std::string, Curve>> curves;
  for (const Case& one : cases)
    for (const double drift : one.drifts) {
      const ray::RayCloud rays = scan(one.scene, one.rays, drift);
      const std::string name =
          one.name +
          (one.drifts.size() > 1 ? ", " + std::to_string(std::lround(100 * drift)) + " cm drift" : "");
      curves.emplace_back(name, curve_of(one.scene, judge(rays, false)));
      curve_row(name, curves.back().second, bars_of(one, drift));
      curve_row(name + ", --paper", curve_of(one.scene, judge(rays, true)), {});
    }
  for (const auto& [name, curve] : curves)
    class_table(name, curve);
}

}  // namespace bench
