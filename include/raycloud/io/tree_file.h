#pragma once
/// Trees as text (docs/formats.md): the format of the TreeTools companion programs.
///
/// `#` lines are comments. The heading names the fields, with commas: those of a tree, then
/// `x,y,z,radius[,parent_id]` and further ones of a segment. Each other line is a tree: its own fields, then
/// those of each segment in turn. `parent_id` counts the segments of the tree from 0 and is -1 for the first;
/// where it is missing a tree has one segment. Every other field, known or not, is kept as a number.

#include <raycloud/core/forest.h>
#include <raycloud/io/file_options.h>

#include <filesystem>

namespace ray {

/// Positions and radii are finite and radii not negative; parents come before their children. A file with a
/// heading and no tree is a forest without trees. Memory: the forest and the longest line.
///
/// Throws Error: file_not_found, file_access, and file_format that names the line where it is not such a file
/// or a line is cut.
[[nodiscard]] Forest read_trees(const std::filesystem::path& path);

/// Reads back to the same forest, every bit of every number (comments lose blanks at their ends; blanks and
/// commas in names become `_`). The file appears, complete, on return. Preconditions: each tree and segment
/// has as many attributes as the forest names, a tree has a segment, its first has no parent and the others
/// do. Throws Error(file_access).
void write_trees(const std::filesystem::path& path, const Forest& forest, const WriteOptions& options = {});

}  // namespace ray
