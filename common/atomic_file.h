// Files that appear whole or not at all.
#pragma once

#include <string>
#include <string_view>

namespace foresight {

// Writes to a temporary beside the target, syncs, renames. Content equal to what is there already is not rewritten (its
// time stays, so that a build does not go on). Returns whether the file changed. Throws InputError when it cannot be
// written; the old file is then untouched and no temporary is left.
bool write_file_atomically(const std::string& file, std::string_view content);

// The whole file. Throws InputError when it is missing, a directory or unreadable.
[[nodiscard]] std::string read_whole_file(const std::string& file);

}  // namespace foresight
