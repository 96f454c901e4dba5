// What a photograph's file states of its exposure and orientation (EXIF: CIPA DC-008; in JPEG, TIFF and PNG).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace catchlight::render {

struct ExifTags {
  std::optional<double> time_s = {}, f_number = {}, iso = {};
  std::optional<int> orientation = {};  ///< 1 to 8; 1: as it is
};

/// The tags of a whole file in memory. What is missing, damaged or not above 0 is empty; no byte beyond the file is read.
ExifTags exif_tags(std::span<const std::uint8_t> file);

/// Light per unit of radiance, in s: time · (ISO / 100) / f-number². ISO and f-number count only where the file states them.
std::optional<double> exposure_of(const ExifTags& tags);

}  // namespace catchlight::render
