// Files that a user asked for: refused before the work where they cannot be written, and never half there.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "catchlight/util/pending_file.hpp"

namespace catchlight::app {

/// The file `path`, not under its name yet. Throws UsageError where `path` exists and `overwrite` is false, and where it is no
/// file that could be replaced; Error where its folder does not exist or nothing can be written there.
PendingFile pending_output(const std::string& path, bool overwrite);

/// Throws as pending_output, and leaves nothing behind.
void check_output_path(const std::string& path, bool overwrite);

/// Throws UsageError where both names are one file's.
void refuse_same_file(const std::string& output, const std::string& input);

/// Throws UsageError where two of `outputs` are one file, or one of them is an input. What is no file is never one, be it empty,
/// a pattern or an address.
void refuse_shared_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Makes `folder`, for files yet to come, where it is missing. Throws Error where that fails.
void make_output_folder(const std::string& folder);

/// Throws as pending_output, and Error where writing fails; then nothing is left behind.
void write_text_file(const std::string& path, std::string_view text, bool overwrite);

}  // namespace catchlight::app
