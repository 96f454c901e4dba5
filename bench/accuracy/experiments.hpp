// What is measured besides the ladders of stress.
#pragma once

#include <filesystem>
#include <optional>

namespace catchlight::tracking {

/// Error against stress, a table and (where `csv_folder` is given) a file for each kind.
void measure_ladders(const std::optional<std::filesystem::path>& csv_folder);

/// Standard deviation of a still tag's corners over 60 noises, per axis.
void measure_jitter();

/// How often the mirrored pose is taken for the true one on 100 trajectories of a small tag near frontal.
void measure_branches();

/// Path-traced plates with poses, in `folder`; a note where they are not there.
void measure_plates(const std::filesystem::path& folder);

}  // namespace catchlight::tracking
