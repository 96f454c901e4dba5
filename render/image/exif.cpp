#include "render/image/exif.hpp"

#include <cstring>
#include <string_view>

namespace catchlight::render {
namespace {

using Bytes = std::span<const std::uint8_t>;

enum : std::uint32_t { kOrientation = 0x0112, kExifPointer = 0x8769, kExposureTime = 0x829a, kFNumber = 0x829d, kIso = 0x8827 };
enum : std::uint32_t { kShort = 3, kLong = 4, kRational = 5 };

std::optional<std::uint32_t> number_at(Bytes bytes, std::size_t at, std::size_t size, bool big_endian) {
  if (at > bytes.size() || bytes.size() - at < size) return std::nullopt;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + (big_endian ? i : size - 1 - i)];
  return value;
}

bool starts_with(Bytes bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

/// A TIFF block: what EXIF is wrapped in.
class Tiff {
 public:
  explicit Tiff(Bytes bytes) : bytes_(bytes), big_endian_(starts_with(bytes, "MM")) {}

  ExifTags tags() const {
    ExifTags tags;
    const auto first = value(4, 4);
    const auto orientation = first ? positive(*first, kOrientation) : std::nullopt;
    if (orientation && *orientation <= 8) tags.orientation = static_cast<int>(*orientation);
    const auto entry = first ? find(*first, kExifPointer) : std::nullopt;
    const auto directory = entry ? value(*entry + 8, 4) : std::nullopt;
    if (!directory) return tags;
    tags.time_s = positive(*directory, kExposureTime);
    tags.f_number = positive(*directory, kFNumber);
    tags.iso = positive(*directory, kIso);
    return tags;
  }

 private:
  std::optional<std::uint32_t> value(std::size_t at, std::size_t size) const { return number_at(bytes_, at, size, big_endian_); }

  /// The offset at which the directory's entry of that tag starts.
  std::optional<std::size_t> find(std::size_t directory, std::uint32_t tag) const {
    constexpr std::size_t kEntryBytes = 12;
    const auto count = value(directory, 2);
    for (std::size_t i = 0; count && i < *count; ++i) {
      const std::size_t entry = directory + 2 + i * kEntryBytes;
      const auto found = value(entry, 2);
      if (!found) break;
      if (*found == tag) return entry;
    }
    return std::nullopt;
  }

  std::optional<double> positive(std::size_t directory, std::uint32_t tag) const {
    const auto entry = find(directory, tag);
    if (!entry) return std::nullopt;
    const auto type = value(*entry + 2, 2), here = value(*entry + 8, type == kShort ? 2 : 4);
    if (!type || !here) return std::nullopt;
    double number = *here;
    if (*type == kRational) {
      const auto numerator = value(*here, 4), denominator = value(std::size_t{*here} + 4, 4);
      if (!numerator || denominator.value_or(0) == 0) return std::nullopt;
      number = static_cast<double>(*numerator) / *denominator;
    } else if (*type != kShort && *type != kLong) {
      return std::nullopt;
    }
    return number > 0 ? std::optional(number) : std::nullopt;
  }

  Bytes bytes_;
  bool big_endian_;
};

Bytes tiff_in_jpeg(Bytes file) {
  constexpr std::string_view kExif("Exif\0\0", 6);
  constexpr std::uint8_t kApp1 = 0xe1, kScan = 0xda;
  for (std::size_t at = 2; at + 4 <= file.size() && file[at] == 0xff && file[at + 1] != kScan;) {
    const std::size_t length = *number_at(file, at + 2, 2, true);
    const Bytes segment = file.subspan(at + 4);
    if (file[at + 1] == kApp1 && starts_with(segment, kExif)) return segment.subspan(kExif.size());
    at += 2 + length;
  }
  return {};
}

Bytes tiff_in_png(Bytes file) {
  for (std::size_t at = 8; at + 8 <= file.size();) {
    const std::size_t length = *number_at(file, at, 4, true);
    if (starts_with(file.subspan(at + 4), "eXIf")) return file.subspan(at + 8);
    at += 12 + length;
  }
  return {};
}

}  // namespace

ExifTags exif_tags(Bytes file) {
  Bytes tiff;
  if (starts_with(file, "\xff\xd8")) tiff = tiff_in_jpeg(file);
  if (starts_with(file, "\x89PNG")) tiff = tiff_in_png(file);
  if (starts_with(file, "II") || starts_with(file, "MM")) tiff = file;
  return Tiff(tiff).tags();
}

std::optional<double> exposure_of(const ExifTags& tags) {
  if (!tags.time_s) return std::nullopt;
  const double f_number = tags.f_number.value_or(1);
  return *tags.time_s * tags.iso.value_or(100) / 100 / (f_number * f_number);
}

}  // namespace catchlight::render
