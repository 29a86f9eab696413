#include "cli/cli.h"
#include "cli/grouped.h"
#include "cloud_to_cloud.h"
#include "pipe_steps.h"

#include <algorithm>
#include <array>

namespace {

using namespace ray::cli;

const Command kCommand{
    .name = "raypipe",
    .summary = "run several commands as one, without files between them",
    .description =
        R"(`raycloud pipe cloud.ply decimate 4 cm : split range 30 : colour time` gives the cloud that
`raydecimate`, `raysplit` and `raycolour` would have given one after the other, byte for byte, but
reads and writes once. Steps are parted by a colon between spaces; each has the words of its command
without the cloud.

Of a step with two outputs the first goes on, or the one that is named behind its words:
`split range 30 outside`. A step that must read its input twice (`split time 3 %`, `colour image`)
gets it as a file beside the output, which is removed at the end.)",
    .usages = {{.words = {cloud(), texts("STEPS")},
                .help = "the commands' words, steps parted by colons",
                .example = "raypipe cloud.ply decimate 4 cm : colour time"}},
    .options = {output_option("CLOUD_pipe.ply"), view_option()},
    .writes = "CLOUD_pipe.ply",
    .memory = "What its steps take, all at once.",
    .see_also = {"raycloud", "raydecimate", "raysplit", "raycolour"}};

void run(const Match& match, Session& session) {
  const std::string& input = match.text("CLOUD");
  const auto output = main_output(match, input, "_pipe");
  std::vector<ray::tools::PipeStep> steps = ray::tools::parse_pipe(match.files("STEPS"));
  std::erase_if(steps, [](const ray::tools::PipeStep& one) {
    return one.step->does_nothing != nullptr && one.step->does_nothing(one.match);
  });
  if (steps.empty()) match.reject("STEPS", "these steps change nothing");
  const ray::tools::PipeReport report = run_pipe(session.context(), input, steps, output);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const ray::tools::StepReport& step = report.steps[i];
    const std::string name = steps[i].step->command.name.substr(3);
    for (const std::string& note : step.notes)
      session.note(name + ": " + note);
    session.note(name + ": " + grouped(step.counts.rays_in) + " rays in, " +
                 grouped(step.rays_out[steps[i].output]) + " out");
  }
  ray::tools::note_dropped(session, report.steps.front().counts.dropped);
  session.summary({.rays_in = report.steps.front().counts.rays_in,
                   .rays_out = report.steps.back().rays_out[steps.back().output],
                   .files = {output}});
}

/// Options of the pipe go to the front, so that `--` can keep those of the steps from its parser.
std::vector<std::string> sorted(int argc, char** argv) {
  constexpr std::array<std::string_view, 3> kWithValue{"-o", "--output", "--threads"};
  constexpr std::array<std::string_view, 5> kFlags{"-q", "--quiet", "-v", "--view", "--version"};
  std::vector<std::string> options;
  std::vector<std::string> words;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const std::string_view name = word.substr(0, word.find('='));
    const bool value =
        std::find(kWithValue.begin(), kWithValue.end(), name) != kWithValue.end() || name == "--memory";
    if (value || std::find(kFlags.begin(), kFlags.end(), word) != kFlags.end()) {
      options.emplace_back(word);
      if (value && name == word && i + 1 < argc) options.emplace_back(argv[++i]);
    } else {
      words.emplace_back(word);
    }
  }
  options.emplace_back("--");
  options.insert(options.end(), words.begin(), words.end());
  return options;
}

}  // namespace

int main(int argc, char** argv) {
  const bool asks = argc == 1 || std::any_of(argv + 1, argv + argc, [](std::string_view word) {
                      return word == "-h" || word == "--generate" || word.starts_with("--help");
                    });
  if (asks) return ray::cli::main(kCommand, run, argc, argv);
  std::vector<std::string> words = sorted(argc, argv);
  std::vector<char*> arguments{argv[0]};
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return ray::cli::main(kCommand, run, static_cast<int>(arguments.size()) - 1, arguments.data());
}
