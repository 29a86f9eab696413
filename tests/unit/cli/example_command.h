#pragma once
/// A command with every kind of word, for the tests.

#include "cli/cli.h"

inline const ray::cli::Command& thin() {
  using namespace ray::cli;
  static const Command kCommand{
      .name = "raythin",
      .summary = "thin a ray cloud",
      .description = "Keeps the first ray of each cube.\n\nUnits are `cm`.",
      .usages = {{.name = "width",
                  .words = {cloud(), length("WIDTH")},
                  .help = "one ray per cube of this width",
                  .example = "raythin cloud.ply 4 cm"},
                 {.name = "every",
                  .words = {cloud(), count("N", "ray")},
                  .help = "every Nth ray",
                  .example = "raythin cloud.ply 10 rays"},
                 {.name = "per",
                  .words = {cloud(), length_per("WIDTH", "ray")},
                  .help = "drops rays that cross only crossed cubes",
                  .example = "raythin cloud.ply 20 cm/ray"},
                 {.name = "points",
                  .words = {cloud(), length("WIDTH"), count("N", "point")},
                  .help = "at most so many points per cube",
                  .example = "raythin cloud.ply 20 cm 64 points"}},
      .options =
          {output_option("CLOUD_thin.ply"),
           view_option(),
           {.name = "resolution",
            .letter = 'r',
            .value = integer("PIXELS", kPositive),
            .help = "longest side of the image",
            .fallback = "512"},
           {.name = "shift", .value = vector("X,Y,Z"), .help = "moves it", .advanced = true},
           {.name = "time_offset", .value = number("S"), .help = "seconds to add", .advanced = true},
           {.name = "ground", .value = input("MESH", {".ply"}), .help = "the ground", .usages = {"width"}},
           {.name = "lit", .help = "adds shading"}},
      .writes = "CLOUD_thin.ply",
      .memory = "24 bytes per kept cube.",
      .see_also = {"raydecimate"}};
  return kCommand;
}
