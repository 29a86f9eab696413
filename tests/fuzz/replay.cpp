// Runs a fuzz target on every file of a folder, whole and cut short: the seed corpus as an ordinary test. A
// finding of the fuzzer becomes a test by adding its file to the corpus.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

std::vector<std::uint8_t> read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 || !std::filesystem::is_directory(argv[1])) {
    std::fprintf(stderr, "usage: %s CORPUS_FOLDER\n", argv[0]);
    return 2;
  }
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1]))
    paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    std::printf("%s\n", path.filename().c_str());
    std::fflush(stdout);  // the last line names the input that brings the program down
    const std::vector<std::uint8_t> input = read(path);
    for (std::size_t tenths = 0; tenths <= 10; ++tenths) {
      // An exact copy, so that the address sanitizer sees every byte read past the end.
      const std::vector<std::uint8_t> cut(
          input.begin(), input.begin() + static_cast<std::ptrdiff_t>(input.size() * tenths / 10));
      LLVMFuzzerTestOneInput(cut.data(), cut.size());
    }
  }
  std::printf("%zu inputs\n", paths.size());
  return paths.empty() ? 1 : 0;
}
