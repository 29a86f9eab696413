#pragma once
/// Reading a text file, whole or line by line, with the errors every text format shares.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace ray::text {

/// A file read from the front. Throws Error(file_not_found) and Error(file_access).
class TextFile {
 public:
  explicit TextFile(std::filesystem::path path);

  /// Up to `bytes` more; fewer only at the end.
  [[nodiscard]] std::string read(std::size_t bytes);
  void rewind() { std::rewind(file_.get()); }
  [[nodiscard]] std::string name() const { return path_.string(); }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Yields whole lines. A line longer than 64 MiB is no text: Error(file_format).
class LineReader {
 public:
  explicit LineReader(TextFile& file) : file_(file) {}

  /// The next lines, at most `most`, with their line feeds; empty at the end. Valid until the next call.
  [[nodiscard]] std::string_view next(std::size_t most);
  /// How many lines the last call gave.
  [[nodiscard]] std::size_t lines() const { return lines_; }
  void rewind();

 private:
  bool fill();

  TextFile& file_;
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t lines_ = 0;
  bool at_end_ = false;
};

}  // namespace ray::text
