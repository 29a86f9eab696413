// Normals, outliers and smoothing beside other programs, on the same points.
//   bench_peers BIN_FOLDER CLOUD.ply WORK_FOLDER
// Prints a Markdown table: whole commands, from file to file, each peer in turn with ours. What is not
// installed says so. Ours keep whole rays, which are three times as many bytes as the peers' points.

#include "../table.h"
#include "peer_points.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace bench;

constexpr int kPairs = 1;  // after a warm-up; some peers take minutes

/// Whether a command ends well, with nothing said.
bool works(const std::string& command) {
  return std::system(("(" + command + ") >/dev/null 2>&1").c_str()) == 0;
}

struct Command {
  std::string what;     ///< as printed
  std::string command;  ///< writes `out`
  std::string out;
  std::string needs;  ///< a command that works where it is installed
};

Subject subject_of(const Command& command) {
  return {command.command + " 2>/dev/null && test -s " + command.out, "rm -f " + command.out};
}

struct Operation {
  Command ours;
  std::vector<Command> peers;
};

void print(const Command& command, const PeerPoints& points, const Result& result) {
  const double count = static_cast<double>(points.count);
  std::printf("| %s | %.2f s | %.2f | %.0f MB | ", command.what.c_str(), result.seconds,
              count / result.seconds / 1e6, result.peak_megabytes);
  if (result.base_seconds > 0.0) std::printf("%.2f × ours", result.ratio);
  std::printf(" |\n");
  std::fflush(stdout);
}

void print_missing(const Command& command, const char* why) {
  std::printf("| %s | %s | | | |\n", command.what.c_str(), why);
}

void compare(const Operation& operation, const PeerPoints& points) {
  const Subject ours = subject_of(operation.ours);
  const bool built = works(operation.ours.needs);
  if (built) {
    print(operation.ours, points, time_alone(ours, 3));
  } else {
    print_missing(operation.ours, "not built");
  }
  for (const Command& peer : operation.peers) {
    if (!works(peer.needs)) {
      print_missing(peer, "not installed");
      continue;
    }
    const Subject subject = subject_of(peer);
    print(peer, points, built ? time_against(subject, ours, kPairs) : time_alone(subject, kPairs));
    run("rm -f " + peer.out);
  }
  run("rm -f " + operation.ours.out);
}

class Programs {
 public:
  Programs(const Paths& paths, std::string points, double radius)
      : paths_(paths), points_(std::move(points)), radius_(std::to_string(radius)) {}

  [[nodiscard]] Command ours(const std::string& name, const std::string& words) const {
    const std::string out = paths_.file("ours.ply");
    const std::string command = paths_.bin + "/" + name + " -q " + paths_.big + " " + words + " -o " + out;
    return {name + (words.empty() ? "" : " " + words), command, out, command};
  }
  [[nodiscard]] Command pcl(const std::string& what, const std::string& operation,
                            const std::string& radius = "") const {
    const std::string out = paths_.file("peer.bin");
    const std::string program = paths_.bin + "/peer_pcl";
    return {"PCL " + what, program + " " + operation + " " + points_ + " " + out + " " + radius, out,
            "test -x " + program};
  }
  /// By the system's Python, which has the package.
  [[nodiscard]] Command open3d(const std::string& what, const std::string& operation,
                               const std::string& radius = "") const {
    const std::string out = paths_.file("peer.ply");
    const std::string python = "/usr/bin/python3";
    return {
        "Open3D " + what,
        python + " " RAYCLOUD_PEERS "/peer_open3d.py " + operation + " " + points_ + " " + out + " " + radius,
        out, python + " -c 'import open3d'"};
  }
  [[nodiscard]] Command cloud_compare(const std::string& what, const std::string& words) const {
    const std::string out = paths_.file("peer_cc.ply");
    return {"CloudCompare " + what,
            "env QT_QPA_PLATFORM=offscreen CloudCompare -SILENT -AUTO_SAVE OFF -NO_TIMESTAMP -O " + points_ +
                " " + words + " -C_EXPORT_FMT PLY -SAVE_CLOUDS FILE " + out,
            out, "command -v CloudCompare"};
  }
  [[nodiscard]] const std::string& radius() const { return radius_; }

 private:
  const Paths& paths_;
  std::string points_;
  std::string radius_;  ///< m, of about 16 neighbours
};

std::vector<Operation> operations(const Programs& p) {
  return {{p.ours("raydenoise", "4 cm"),
           {p.pcl("RadiusOutlierRemoval, 4 cm", "radius", "0.04"),
            p.open3d("remove_radius_outlier, 4 cm", "radius", "0.04")}},
          {p.ours("raydenoise", "3 sigmas"),
           {p.pcl("StatisticalOutlierRemoval, 16", "outliers"),
            p.open3d("remove_statistical_outlier, 16", "outliers"), p.cloud_compare("SOR, 16", "-SOR 16 3")}},
          {p.ours("raysmooth", ""), {p.pcl("MovingLeastSquares, radius of 16", "smooth", p.radius())}},
          {p.ours("raycolour", "normal"),
           {p.pcl("NormalEstimationOMP, 16", "normals"), p.open3d("estimate_normals, 16", "normals"),
            p.cloud_compare("OCTREE_NORMALS, radius of 16", "-OCTREE_NORMALS " + p.radius())}}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bench_peers BIN_FOLDER CLOUD.ply WORK_FOLDER\n");
    return 2;
  }
  const Paths paths{argv[1], argv[2], argv[3]};
  const std::string file = paths.file("peer_points.ply");
  const PeerPoints points = write_peer_points(paths.big, file);
  std::printf("\nOther programs, %zu points, 16 neighbours within %.1f cm\n\n", points.count,
              100 * points.radius);
  std::printf("| command | seconds | M points/s | peak memory | time |\n|---|---|---|---|---|\n");
  for (const Operation& operation : operations(Programs(paths, file, points.radius)))
    compare(operation, points);
  run("rm -f " + file);
  return 0;
}
