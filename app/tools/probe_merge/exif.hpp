// The exposure that a photograph's file states (EXIF: CIPA DC-008; in JPEG, TIFF and PNG).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace catchlight::app {

struct ExposureTags {
  std::optional<double> time_s, f_number, iso;
};

/// The exposure tags of a whole file in memory. What is missing, damaged or not above 0 is empty; no byte beyond the file is
/// read.
ExposureTags exposure_tags(std::span<const std::uint8_t> file);

/// Light per unit of radiance, in s: time · (ISO / 100) / f-number². ISO and f-number count only where the file states them.
std::optional<double> exposure_of(const ExposureTags& tags);

}  // namespace catchlight::app
