// Radiance RGBE (Ward, "Real Pixels", Graphics Gems II, 1991): value = mantissa / 256 * 2^(exponent - 128); exponent 0 is black.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "catchlight/error.hpp"
#include "catchlight/image.hpp"
#include "catchlight/util/pending_file.hpp"
#include "render/image/image_io.hpp"

namespace catchlight::render {
namespace {

constexpr int kMaxSide = 32767;  // longest line of the run-length encoding
using Rgbe = std::array<std::uint8_t, 4>;

struct Header {
  int first_count = 0, second_count = 0;  ///< the sizes in the resolution line's order
  char first_axis = 'Y', second_axis = 'X';
  bool first_positive = false, second_positive = true;
  double exposure = 1.0;
  std::string probe_layout;
};

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(path + ": cannot be read as Radiance HDR: " + why);
}

Header read_header(std::istream& in, const std::string& path) {
  Header header;
  std::string line;
  if (!std::getline(in, line) || line.rfind("#?", 0) != 0) refuse(path, "it does not start with #?RADIANCE");
  while (std::getline(in, line) && !line.empty() && line != "\r") {
    if (line.rfind("FORMAT=", 0) == 0 && line.find("32-bit_rle_rgbe") == std::string::npos)
      refuse(path, "expected FORMAT=32-bit_rle_rgbe, found " + line);
    if (line.rfind("EXPOSURE=", 0) == 0) header.exposure *= std::strtod(line.c_str() + 9, nullptr);
    if (line.starts_with(std::string(kProbeLayout) + '=')) header.probe_layout = line.substr(line.find('=') + 1);
  }
  if (!std::getline(in, line)) refuse(path, "the header never ends");
  char first_sign = 0, second_sign = 0;
  if (std::sscanf(line.c_str(), " %c%c %d %c%c %d", &first_sign, &header.first_axis, &header.first_count, &second_sign,
                  &header.second_axis, &header.second_count) != 6 ||
      header.first_axis + header.second_axis != 'X' + 'Y') {
    refuse(path, "expected a line such as \"-Y height +X width\", found \"" + line + "\"");
  }
  header.first_positive = first_sign == '+';
  header.second_positive = second_sign == '+';
  if (std::min(header.first_count, header.second_count) < 1 || std::max(header.first_count, header.second_count) > kMaxSide) {
    refuse(path, "size out of range: \"" + line + "\"");
  }
  if (!(header.exposure > 0) || !std::isfinite(header.exposure)) refuse(path, "its EXPOSURE is not a positive number");
  return header;
}

class ScanlineReader {
 public:
  ScanlineReader(std::istream& in, const std::string& path) : in_(in), path_(path) {}

  void read(std::vector<Rgbe>& line) {
    Rgbe start{};
    for (auto& value : start) value = byte();
    const std::size_t count = line.size();
    if (start[0] == 2 && start[1] == 2 && start[2] < 128 && count >= 8) {
      if (static_cast<std::size_t>(start[2]) << 8 != (count & 0xff00) || start[3] != (count & 0xff))
        refuse(path_, "a scanline of another width");
      for (int c = 0; c < 4; ++c) read_component(line, c);
    } else {
      read_flat(line, start);
    }
  }

 private:
  std::uint8_t byte() {
    const int value = in_.get();
    if (value == std::char_traits<char>::eof()) refuse(path_, "the file ends early");
    return static_cast<std::uint8_t>(value);
  }

  void read_component(std::vector<Rgbe>& line, int c) {
    for (std::size_t i = 0; i < line.size();) {
      const int code = byte(), length = code > 128 ? code - 128 : code;
      if (length == 0 || i + length > line.size()) refuse(path_, "damaged run lengths");
      const std::uint8_t repeated = code > 128 ? byte() : 0;
      for (int k = 0; k < length; ++k) line[i++][c] = code > 128 ? repeated : byte();
    }
  }

  // Uncompressed, or the old encoding where (1, 1, 1, n) repeats the last pixel n times, further ones 256 times as often.
  void read_flat(std::vector<Rgbe>& line, Rgbe pixel) {
    std::size_t i = 0;
    int shift = 0;
    for (;;) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t repeats = shift < 24 ? static_cast<std::size_t>(pixel[3]) << shift : line.size() + 1;
        if (i == 0 || i + repeats > line.size()) refuse(path_, "damaged run lengths");
        for (std::size_t k = 0; k < repeats; ++k, ++i) line[i] = line[i - 1];
        shift += 8;
      } else {
        line[i++] = pixel;
        shift = 0;
      }
      if (i == line.size()) return;
      for (auto& value : pixel) value = byte();
    }
  }

  std::istream& in_;
  const std::string& path_;
};

Rgbe encode(const float* rgb) {
  const float largest = std::max({rgb[0], rgb[1], rgb[2], 0.0f});
  if (!(largest > 1e-38f)) return {};
  int exponent = 0;
  const float scale = std::frexp(std::min(largest, 1e38f), &exponent) * 256.0f / largest;
  Rgbe code{};
  for (int c = 0; c < 3; ++c) code[c] = static_cast<std::uint8_t>(std::clamp(rgb[c] * scale, 0.0f, 255.0f));
  code[3] = static_cast<std::uint8_t>(exponent + 128);
  return code;
}

// Components one after the other in literal runs: every reader takes it, and probes hardly have equal neighbours.
void write_scanline(std::ostream& out, const std::vector<Rgbe>& line) {
  const std::size_t count = line.size();
  if (count >= 8 && count <= kMaxSide) {
    for (const std::size_t value : {std::size_t{2}, std::size_t{2}, count >> 8, count & 0xff}) out.put(static_cast<char>(value));
    for (int c = 0; c < 4; ++c) {
      for (std::size_t i = 0; i < count; i += 128) {
        const std::size_t length = std::min<std::size_t>(128, count - i);
        out.put(static_cast<char>(length));
        for (std::size_t k = 0; k < length; ++k) out.put(static_cast<char>(line[i + k][c]));
      }
    }
    return;
  }
  for (const Rgbe& pixel : line) out.write(reinterpret_cast<const char*>(pixel.data()), 4);
}

}  // namespace

ExrPicture read_hdr_picture(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be opened");
  const Header header = read_header(in, path);
  const bool rows_first = header.first_axis == 'Y';
  Image image(rows_first ? header.second_count : header.first_count, rows_first ? header.first_count : header.second_count);
  ScanlineReader reader(in, path);
  std::vector<Rgbe> line(header.second_count);
  for (int i = 0; i < header.first_count; ++i) {
    reader.read(line);
    for (int k = 0; k < header.second_count; ++k) {
      // +X runs right, +Y runs up.
      const int first = header.first_positive == rows_first ? header.first_count - 1 - i : i;
      const int second = header.second_positive == rows_first ? k : header.second_count - 1 - k;
      float* pixel = rows_first ? image.pixel(second, first) : image.pixel(first, second);
      if (line[k][3] == 0) continue;
      const double scale = std::ldexp(1.0, line[k][3] - 136) / header.exposure;
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(line[k][c] * scale);
    }
  }
  ExrPicture picture;
  picture.display = {0, 0, image.width, image.height};
  picture.image = std::move(image);
  picture.probe_layout = header.probe_layout;
  return picture;
}

Image read_hdr(const std::string& path) {
  return read_hdr_picture(path).image;
}

void write_hdr(const std::string& path, const Image& image, const std::string& probe_layout) {
  PendingFile file(path);
  std::ofstream out(file.pending_path(), std::ios::binary);
  out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
  if (!probe_layout.empty()) out << kProbeLayout << '=' << probe_layout << '\n';
  out << "\n-Y " << image.height << " +X " << image.width << "\n";
  std::vector<Rgbe> line(image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) line[x] = encode(image.pixel(x, y));
    write_scanline(out, line);
  }
  out.close();
  if (!out) throw Error(path + ": cannot be written; is the disk full?");
  file.commit();
}

}  // namespace catchlight::render
