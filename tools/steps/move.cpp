#include "mesh_words.h"
#include "steps.h"

#include <raycloud/core/pose.h>
#include <raycloud/filter/transform.h>

#include <algorithm>
#include <numbers>

namespace ray::tools {
namespace {

using namespace ray::cli;

const Command kTranslate{
    .name = "raytranslate",
    .summary = "move a ray cloud, in place",
    .description =
        R"(Adds an offset in metres to the starts and ends of all rays and, with a fourth number, seconds to
their times. With a mesh, adds its height at each place or takes it away: `subtract` makes a ground flat, so
that z is the height above it. Where the mesh has several surfaces above each other the highest counts, and
beside it the height of its nearest edge. The file itself is changed: moving by the opposite offset undoes
it, and so does `add` after `subtract`. The new file replaces the old one only when it is complete and safely
on the disk.

A file with coordinates in single precision becomes double where the new coordinates would lose more
than 25 micrometres.)",
    .usages = {{.name = "offset",
                .words = {cloud(), vector("X,Y,Z[,T]")},
                .help = "by metres along each axis, and seconds",
                .example = "raytranslate cloud.ply 0,0,-1.5"},
               {.name = "heights",
                .words = {cloud(), choice("WAY", {"add", "subtract"}), input("MESH", {".ply", ".obj"})},
                .help = "up or down by the height of the mesh at each place",
                .example = "raytranslate cloud.ply subtract cloud_mesh.ply"}},
    .options = {view_option()},
    .writes = "CLOUD itself",
    .memory = "Less than 200 MB for any cloud, and 150 bytes for each face of a mesh.",
    .see_also = {"rayrotate", "rayextract"}};

const Command kRotate{
    .name = "rayrotate",
    .summary = "rotate a ray cloud about the origin, in place",
    .description =
        R"(Turns starts and ends of all rays about the origin. The three numbers are a rotation vector: its
direction is the axis, its length the angle in degrees, counter-clockwise seen against the axis;
`0,0,90` turns the x axis onto the y axis. The file itself is changed: rotating by the opposite
vector undoes it. The new file replaces the old one only when it is complete and safely on the disk.

A file with coordinates in single precision becomes double where the new coordinates would lose more
than 5 micrometres.)",
    .usages = {{.words = {cloud(), vector("RX,RY,RZ")},
                .help = "by a rotation vector in degrees",
                .example = "rayrotate cloud.ply 0,0,90"}},
    .options = {view_option()},
    .writes = "CLOUD itself",
    .memory = "Less than 200 MB for any cloud.",
    .see_also = {"raytranslate"}};

/// The most that a move may lose of a coordinate; beyond it the file becomes double. A hundred moves there
/// and back must stay within 0.1 mm: rounding repeats itself after a translation (the second trip takes
/// every point to where the first did) but wanders for a while after rotations, to some 60 times the loss
/// of one.
constexpr double kTranslationLoss = 25e-6;  // m
constexpr double kRotationLoss = 5e-6;

struct Move {
  Pose pose;
  Seconds time_shift;
};

Move translation_of(const Match& match) {
  const std::vector<double>& components = match.components("X,Y,Z[,T]");
  return {translation_pose(match.vector("X,Y,Z[,T]")), {components.size() > 3 ? components[3] : 0.0}};
}

Move rotation_of(const Match& match) {
  return {rotation_pose(match.vector("RX,RY,RZ") * (std::numbers::pi / 180.0)), {}};
}

bool is_nothing(const Move& move) {
  return move.pose.is_identity() && move.time_shift.value == 0.0;
}

CloudInfo info_losing(const RaySource& source, double loss) {
  CloudInfo info = source.info();
  const double step = info.coordinate_step;
  info.coordinate_step = step > 0.0 ? std::min(step, 2.0 * loss) : 2.0 * loss;
  return info;
}

StepReport run(const Context& context, RaySource& source, const SinkMaker& make, const Move& move,
               double loss) {
  RaySink& sink = make(0, info_losing(source, loss));
  return report_of(transform_cloud(context, source, sink, move.pose, move.time_shift));
}

StepReport move_heights(const Match& match, const Context& context, RaySource& source,
                        const SinkMaker& make) {
  const MeshHeight mesh = mesh_height(match.text("MESH"));
  RaySink& sink = make(0, info_losing(source, kTranslationLoss));
  const double factor = match.text("WAY") == "add" ? 1.0 : -1.0;
  const HeightShift shift = shift_by_height(context, source, sink, mesh, factor);
  StepReport report = report_of(shift.stream);
  if (shift.beyond > 0) {
    report.notes.push_back(std::to_string(shift.beyond) + (shift.beyond == 1 ? " ray ends" : " rays end") +
                           " beside the mesh, where the height of its nearest edge is taken");
  }
  return report;
}

StepReport translate(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  if (match.usage() == "heights") return move_heights(match, context, source, make);
  return run(context, source, make, translation_of(match), kTranslationLoss);
}

StepReport rotate(const Match& match, const Context& context, RaySource& source, const SinkMaker& make) {
  return run(context, source, make, rotation_of(match), kRotationLoss);
}

}  // namespace

const Step kTranslateStep{
    .command = kTranslate, .outputs = {{"", ""}}, .run = translate, .does_nothing = [](const Match& match) {
      return match.usage() == "offset" && is_nothing(translation_of(match));
    }};

const Step kRotateStep{
    .command = kRotate, .outputs = {{"", ""}}, .run = rotate, .does_nothing = [](const Match& match) {
      return is_nothing(rotation_of(match));
    }};

}  // namespace ray::tools
