#include "cli/cli.h"
#include "info_report.h"

#include <raycloud/exec/stream.h>
#include <raycloud/filter/cloud_summary.h>
#include <raycloud/filter/origin_audit.h>
#include <raycloud/io/ray_cloud_file.h>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "rayinfo",
    .summary = "what is in a ray cloud",
    .description =
        R"(Reads the whole cloud once and prints how many rays it has and how many of them hit something, its
bounds, time span, the length of the sensor's path, the mean spacing of neighbouring points on
surfaces, the spread of intensities, colours and every extra column, and what its header says:
precision, coordinate system and the commands that made it.

With `--check` the sensor positions are audited too: wrong ones are the usual reason why the removal
of moving objects does not work.)",
    .usages = {{.words = {cloud()}, .help = "print what is in it", .example = "rayinfo cloud.ply"}},
    .options = {{.name = "json", .help = "print a JSON object instead of a table"},
                {.name = "check", .help = "audit the sensor positions"}},
    .writes = "standard output",
    .memory = "Less than 200 MB for any cloud.",
    .see_also = {"rayimport"}};

std::vector<std::string> audit(const Session& session, ray::RaySource& source) {
  source.rewind();
  ray::OriginAudit audit;
  ray::stream(
      session.context(), source, nullptr, [](ray::RayCloud&) { return ray::Nothing{}; },
      [&](ray::RayCloud& rays, ray::Nothing&) { audit.add(rays); });
  return audit.findings(session.context()).findings;
}

void run(const Match& match, Session& session) {
  const auto source = ray::open_ray_cloud(match.text("CLOUD"));
  ray::tools::InfoReport report{.file = match.text("CLOUD"),
                                .info = source->info(),
                                .summary = summarise_cloud(session.context(), *source),
                                .checked = match.has("--check")};
  if (report.checked && report.summary.rays > 0) report.findings = audit(session, *source);
  session.print(match.has("--json") ? as_json(report) : as_text(report));
}

}  // namespace

int main(int argc, char** argv) {
  return ray::cli::main(kCommand, run, argc, argv);
}
