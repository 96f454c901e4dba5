#include "render/image/exif.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

namespace catchlight::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A TIFF block with one Exif directory: 1/250 s, f/8, ISO 200.
Bytes tiff(bool big_endian, std::uint32_t time_denominator = 250) {
  Bytes bytes;
  const auto put = [&](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * (big_endian ? size - 1 - i : i)));
  };
  const auto entry = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t value) {
    put(tag, 2);
    put(type, 2);
    put(1, 4);
    if (type == 3)
      put(value, 2), put(0, 2);
    else
      put(value, 4);
  };
  bytes = big_endian ? Bytes{'M', 'M'} : Bytes{'I', 'I'};
  put(42, 2);
  put(8, 4);
  put(1, 2);  // at 8: one entry
  entry(0x8769, 4, 26);
  put(0, 4);
  put(3, 2);  // at 26: three entries
  entry(0x829a, 5, 68);
  entry(0x829d, 5, 76);
  entry(0x8827, 3, 200);
  put(0, 4);
  put(1, 4), put(time_denominator, 4);  // at 68
  put(80, 4), put(10, 4);
  return bytes;
}

Bytes jpeg(const Bytes& block) {
  Bytes bytes{0xff, 0xd8, 0xff, 0xe0, 0, 4, 0, 0, 0xff, 0xe1, 0, static_cast<std::uint8_t>(block.size() + 8),
              'E',  'x',  'i',  'f',  0, 0};
  for (const std::uint8_t byte : block) bytes.push_back(byte);
  return bytes;
}

Bytes png(const Bytes& block) {
  Bytes bytes{0x89, 'P', 'N', 'G', 13,
              10,   26,  10,  0,   0,
              0,    1,   'a', 'b', 'c',
              'd',  7,   0,   0,   0,
              0,    0,   0,   0,   static_cast<std::uint8_t>(block.size()),
              'e',  'X', 'I', 'f'};
  for (const std::uint8_t byte : block) bytes.push_back(byte);
  return bytes;
}

TEST(Exif, ReadsBothByteOrdersInEveryContainer) {
  for (const bool big_endian : {false, true})
    for (const Bytes& file : {tiff(big_endian), jpeg(tiff(big_endian)), png(tiff(big_endian))}) {
      const ExifTags tags = exif_tags(file);
      EXPECT_DOUBLE_EQ(tags.time_s.value_or(0), 1.0 / 250);
      EXPECT_DOUBLE_EQ(tags.f_number.value_or(0), 8);
      EXPECT_DOUBLE_EQ(tags.iso.value_or(0), 200);
      EXPECT_DOUBLE_EQ(exposure_of(tags).value_or(0), 1.0 / 250 * 2 / 64);
    }
}

TEST(Exif, TimeAloneIsAnExposureAndNothingIsNone) {
  EXPECT_DOUBLE_EQ(exposure_of({0.5, {}, {}}).value_or(0), 0.5);
  EXPECT_FALSE(exposure_of({{}, 8, 100}));
  EXPECT_FALSE(exposure_of(exif_tags({})));
}

TEST(Exif, ADenominatorOfZeroIsNoTime) {
  EXPECT_FALSE(exif_tags(tiff(false, 0)).time_s);
}

/// Each byte lost, and each byte changed to the values that lead furthest astray: nothing is read beyond the file (a sanitizer
/// sees it), nothing loops forever.
TEST(Exif, DamagedFilesAreNeverReadBeyondTheirEnd) {
  for (const Bytes& whole : {tiff(false), tiff(true), jpeg(tiff(true)), png(tiff(false))})
    for (std::size_t i = 0; i < whole.size(); ++i) {
      exif_tags(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(i)));
      for (const std::uint8_t value : {0x00, 0x7f, 0xff}) {
        Bytes changed = whole;
        changed[i] = value;
        const auto exposure = exposure_of(exif_tags(changed));
        EXPECT_TRUE(!exposure || *exposure > 0);
      }
    }
}

}  // namespace
}  // namespace catchlight::render
