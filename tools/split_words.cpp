#include "split_words.h"

#include "mesh_words.h"

#include <raycloud/io/tree_file.h>

#include <memory>
#include <string>

namespace ray::tools {

using namespace cli;

std::vector<Usage> split_in_two_usages() {
  return {
      {.name = "plane",
       .words = {cloud(), literal("plane"), vector("X,Y,Z")},
       .help = "inside: the origin's side of the plane through this point, which is its normal",
       .example = "raysplit cloud.ply plane 0,0,2"},
      {.name = "box",
       .words = {cloud(), literal("box"), vector("X,Y,Z"), vector("RX,RY,RZ", kPositive)},
       .help = "inside: within the box of this centre and these half widths",
       .example = "raysplit cloud.ply box 0,0,1 10,10,1.5"},
      {.name = "capsule",
       .words = {cloud(), literal("capsule"), vector("X1,Y1,Z1"), vector("X2,Y2,Z2"), number("R", kPositive)},
       .help = "inside: at most R metres from the line between the points",
       .example = "raysplit cloud.ply capsule 0,0,0 20,0,0 2.5"},
      {.name = "range",
       .words = {cloud(), literal("range"), number("R", kNonNegative)},
       .help = "inside: rays of at most R metres",
       .example = "raysplit cloud.ply range 10"},
      {.name = "raydir",
       .words = {cloud(), literal("raydir"), vector("X,Y,Z")},
       .help = "inside: rays whose direction, as a vector of length 1, is before the plane of this point",
       .example = "raysplit cloud.ply raydir 0,0,0.8"},
      {.name = "time",
       .words = {cloud(), literal("time"), number("T")},
       .help = "inside: times up to T seconds",
       .example = "raysplit cloud.ply time 1000"},
      {.name = "time_share",
       .words = {cloud(), literal("time"), quantity("P", "%")},
       .help = "inside: the first P percent of the time from first to last ray",
       .example = "raysplit cloud.ply time 3 %"},
      {.name = "alpha",
       .words = {cloud(), literal("alpha"), number("A", between(0.0, 1.0))},
       .help = "inside: alpha up to A; unbounded rays have alpha 0",
       .example = "raysplit cloud.ply alpha 0"},
      {.name = "colour",
       .words = {cloud(), literal("colour"), colour()},
       .help = "inside: colours, as vectors, before the plane of this point",
       .example = "raysplit cloud.ply colour 0.5,0,0"},
      {.name = "single_colour",
       .words = {cloud(), literal("single_colour"), vector("R,G,B", between(0.0, 255.0))},
       .help = "inside: exactly this colour, in whole numbers to 255",
       .example = "raysplit cloud.ply single_colour 255,0,0"},
      {.name = "gap",
       .words = {cloud(), literal("gap"), number("G", kPositive)},
       .help = "inside: the largest set of ends connected by steps shorter than G metres",
       .example = "raysplit cloud.ply gap 0.1"},
      {.name = "shape",
       .words = {cloud(), input("SHAPE", {".ply", ".obj", ".txt"}), literal("distance"), number("D")},
       .help = "inside: ends further than D metres above or outside a mesh, or from the trees of a .txt file",
       .example = "raysplit cloud.ply cloud_mesh.ply distance 0.5"}};
}

namespace {

/// What users should know of a mesh that has, or may have, no inside.
void tell(const MeshDistance& mesh, const std::string& name, std::vector<std::string>& notes) {
  const MeshTopology& topology = mesh.topology();
  const auto note = [&](std::size_t count, const std::string& one, const std::string& many) {
    if (count > 0) notes.push_back(name + " has " + std::to_string(count) + " " + (count == 1 ? one : many));
  };
  note(mesh.faces_without_area(), "face without an area, left out", "faces without an area, left out");
  note(topology.tangled_edges, "edge of three faces or more: sides may be wrong near it",
       "edges of three faces or more: sides may be wrong near them");
  note(topology.reversed_edges, "edge where front meets back, as on a one-sided band",
       "edges where front meets back, as on a one-sided band");
  note(topology.border_loops, "border: it is open, and a plane goes on beyond a border",
       "borders or holes: it is open, and planes go on beyond them");
}

SplitRulePtr split_by_shape(const Match& match, std::vector<std::string>& notes) {
  const std::string& name = match.text("SHAPE");
  const double most = match.number("D");
  const auto dot = name.find_last_of('.');
  const std::string extension = dot == std::string::npos ? "" : name.substr(dot);
  if (extension != ".ply" && extension != ".PLY" && extension != ".obj" && extension != ".OBJ")
    return split_by_trees(read_trees(name), {most});
  const auto distance = std::make_shared<const MeshDistance>(mesh_distance(name));
  tell(*distance, name, notes);
  return split_by_test([distance, most](const RayCloud& rays, std::span<std::uint8_t> inside) {
    distance->are_beyond(rays.ends, most, inside);
  });
}

}  // namespace

SplitRulePtr split_rule(const Match& match, const Context& context, RaySource& source,
                        std::vector<std::string>& notes) {
  const std::string& form = match.usage();
  const Precision stored = source.info().precision;
  if (form == "plane") return split_by_plane(match.vector("X,Y,Z"), stored);
  if (form == "box") return split_by_box(match.vector("X,Y,Z"), match.vector("RX,RY,RZ"), stored);
  if (form == "capsule") {
    return split_by_capsule(match.vector("X1,Y1,Z1"), match.vector("X2,Y2,Z2"), {match.number("R")}, stored);
  }
  if (form == "range") return split_by_range({match.number("R")});
  if (form == "raydir") return split_by_direction(match.vector("X,Y,Z"));
  if (form == "time") return split_by_time({match.number("T")});
  if (form == "time_share") {
    const double percent = match.number("P");
    if (percent > 100.0) match.reject("P", "a share of the time is at most 100 %");
    const Seconds last = time_at(context, source, percent / 100.0);
    source.rewind();
    return split_by_time(last);
  }
  if (form == "alpha") return split_by_alpha(match.number("A"));
  if (form == "colour") return split_by_colour(match.vector("R,G,B"));
  if (form == "single_colour") {
    const Eigen::Vector3d bytes = match.vector("R,G,B");
    if (bytes != Eigen::Vector3d(bytes.array().round())) {
      match.reject("R,G,B", "a single colour is three whole numbers from 0 to 255");
    }
    const auto byte = [&](int i) { return static_cast<std::uint8_t>(bytes[i]); };
    return split_by_single_colour({.red = byte(0), .green = byte(1), .blue = byte(2)});
  }
  if (form == "gap") {
    SplitRulePtr rule = split_by_gap(context, source, {match.number("G")});
    source.rewind();
    return rule;
  }
  return split_by_shape(match, notes);
}

}  // namespace ray::tools
