#include "measure.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace bench {

namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

void prepare(const Subject& subject) {
  if (!subject.prepare.empty() && std::system(subject.prepare.c_str()) != 0) {
    std::fprintf(stderr, "failed: %s\n", subject.prepare.c_str());
    std::exit(1);
  }
}

Run prepared_run(const Subject& subject) {
  prepare(subject);
  return run(subject.command);
}

}  // namespace

Run run(const std::string& command) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    // `exec` leaves the command itself as the measured process where it is a simple one.
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::fprintf(stderr, "failed: %s\n", command.c_str());
    std::exit(1);
  }
  const auto spent = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {seconds, spent(usage.ru_utime) + spent(usage.ru_stime),
          static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6};
}

Result time_alone(const Subject& subject, int runs) {
  std::vector<double> seconds;
  Result result;
  for (int i = 0; i <= runs; ++i) {
    const Run one = prepared_run(subject);
    result.peak_megabytes = std::max(result.peak_megabytes, one.peak_megabytes);
    if (i > 0) seconds.push_back(one.seconds);
  }
  result.seconds = median(seconds);
  return result;
}

Result time_against(const Subject& subject, const Subject& baseline, int runs) {
  std::vector<double> seconds;
  std::vector<double> base;
  std::vector<double> ratios;
  Result result;
  for (int i = 0; i <= runs; ++i) {
    const Run one = prepared_run(subject);
    const Run other = prepared_run(baseline);
    result.peak_megabytes = std::max(result.peak_megabytes, one.peak_megabytes);
    if (i == 0) continue;
    seconds.push_back(one.seconds);
    base.push_back(other.seconds);
    ratios.push_back(one.seconds / other.seconds);
  }
  result.seconds = median(seconds);
  result.base_seconds = median(base);
  result.ratio = median(ratios);
  result.ratio_min = *std::min_element(ratios.begin(), ratios.end());
  result.ratio_max = *std::max_element(ratios.begin(), ratios.end());
  return result;
}

}  // namespace bench
