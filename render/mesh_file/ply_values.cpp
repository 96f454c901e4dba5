#include "render/mesh_file/ply_values.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::render {
namespace {

struct TypeName {
  const char *name, *other;
  std::size_t bytes;
};
constexpr std::array<TypeName, 8> kTypes{{{"char", "int8", 1},
                                          {"uchar", "uint8", 1},
                                          {"short", "int16", 2},
                                          {"ushort", "uint16", 2},
                                          {"int", "int32", 4},
                                          {"uint", "uint32", 4},
                                          {"float", "float32", 4},
                                          {"double", "float64", 8}}};

std::size_t bytes_of(PlyType type) {
  return kTypes[static_cast<std::size_t>(type)].bytes;
}

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words = split(line, ' ');
  std::erase(words, "");
  return words;
}

template <typename T>
double loaded(const std::array<char, 8>& bytes) {
  T value;
  std::memcpy(&value, bytes.data(), sizeof value);
  return static_cast<double>(value);
}

double value_of(PlyType type, const std::array<char, 8>& bytes) {
  switch (type) {
    case PlyType::int8:
      return loaded<std::int8_t>(bytes);
    case PlyType::uint8:
      return loaded<std::uint8_t>(bytes);
    case PlyType::int16:
      return loaded<std::int16_t>(bytes);
    case PlyType::uint16:
      return loaded<std::uint16_t>(bytes);
    case PlyType::int32:
      return loaded<std::int32_t>(bytes);
    case PlyType::uint32:
      return loaded<std::uint32_t>(bytes);
    case PlyType::float32:
      return loaded<float>(bytes);
    default:
      return loaded<double>(bytes);
  }
}

}  // namespace

PlyValues::PlyValues(const std::string& path) : path_(path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be opened");
  bytes_.assign(std::istreambuf_iterator<char>(in), {});
  if (header_line() != "ply") refuse("expected a PLY file, which begins with the line \"ply\"");
  read_header();
  check_counts();
}

void PlyValues::refuse(const std::string& why) const {
  throw Error(path_ + ": " + why);
}

std::string_view PlyValues::header_line() {
  const std::size_t end = bytes_.find('\n', at_);
  if (end == std::string::npos) refuse("the file ends within its header");
  std::string_view line(bytes_.data() + at_, end - at_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  at_ = end + 1;
  return line;
}

void PlyValues::read_header() {
  while (true) {
    const std::string line(header_line());
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "comment") {
      comments_.push_back(line.substr(std::min(line.size(), line.find("comment") + 8)));
    } else if (words[0] == "format") {
      read_format(words);
    } else if (words[0] == "element") {
      const std::optional<std::int64_t> count = words.size() == 3 ? integer_from_text(words[2]) : std::nullopt;
      if (!count || *count < 0) refuse("\"" + line + "\" in its header: expected \"element NAME COUNT\"");
      elements_.push_back({words[1], static_cast<std::size_t>(*count), {}});
    } else if (words[0] == "property" && !elements_.empty()) {
      read_property(words);
    } else {
      refuse("\"" + line + "\" in its header is not understood");
    }
  }
  if (!format_) refuse("its header names no format");
}

void PlyValues::read_format(const std::vector<std::string>& words) {
  const std::string& name = words.size() > 1 ? words[1] : "";
  if (name == "ascii") format_ = Format::ascii;
  if (name == "binary_little_endian") format_ = Format::little_endian;
  if (name == "binary_big_endian") format_ = Format::big_endian;
  if (!format_) refuse("format \"" + name + "\": expected \"ascii\", \"binary_little_endian\" or \"binary_big_endian\"");
}

void PlyValues::read_property(const std::vector<std::string>& words) {
  std::vector<PlyProperty>& properties = elements_.back().properties;
  if (words.size() == 5 && words[1] == "list") {
    properties.push_back({words[4], type_named(words[3]), type_named(words[2])});
  } else if (words.size() == 3) {
    properties.push_back({words[2], type_named(words[1]), std::nullopt});
  } else {
    refuse("a property of \"" + elements_.back().name + "\" has neither type and name, nor \"list\", two types and a name");
  }
}

PlyType PlyValues::type_named(const std::string& name) const {
  for (std::size_t i = 0; i < kTypes.size(); ++i)
    if (name == kTypes[i].name || name == kTypes[i].other) return static_cast<PlyType>(i);
  refuse("its header has a property of the unknown type \"" + name + "\"");
}

/// A number in text is a digit and what separates it from the next.
std::size_t PlyValues::least_bytes(PlyType type) const {
  return format_ == Format::ascii ? 2 : bytes_of(type);
}

void PlyValues::check_counts() const {
  const std::size_t left = bytes_.size() - at_ + 1;  // the last number needs nothing behind it
  for (const PlyElement& element : elements_) {
    std::size_t row = 0;
    for (const PlyProperty& property : element.properties) row += least_bytes(property.count_type.value_or(property.type));
    if (element.count > 0 && (row == 0 || element.count > left / row)) {
      refuse("its header promises " + std::to_string(element.count) + " of \"" + element.name +
             "\", but the file ends before: it is cut short or damaged");
    }
  }
}

double PlyValues::next(PlyType type) {
  if (format_ == Format::ascii) return next_word();
  const std::size_t size = bytes_of(type);
  if (size > bytes_.size() - at_) refuse("the file ends too early: it is cut short or damaged");
  std::array<char, 8> value{};
  std::copy_n(bytes_.data() + at_, size, value.begin());
  at_ += size;
  const bool file_is_big = format_ == Format::big_endian;
  if (file_is_big != (std::endian::native == std::endian::big))
    std::reverse(value.begin(), value.begin() + static_cast<int>(size));
  return value_of(type, value);
}

double PlyValues::next_word() {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t start = std::min(bytes_.find_first_not_of(kBlank, at_), bytes_.size());
  if (start == bytes_.size()) refuse("the file ends too early: it is cut short or damaged");
  at_ = std::min(bytes_.find_first_of(kBlank, start), bytes_.size());
  std::string_view word(bytes_.data() + start, at_ - start);
  if (word.starts_with('+')) word.remove_prefix(1);
  const std::optional<double> value = real_from_text(word);
  if (!value) refuse("\"" + std::string(word.substr(0, 40)) + "\" stands where a number is expected");
  return *value;
}

std::size_t PlyValues::next_count(PlyType type, PlyType of) {
  const double count = next(type);
  if (!(count >= 0) || count != std::floor(count) || count > static_cast<double>((bytes_.size() - at_ + 1) / least_bytes(of)))
    refuse("a list claims " + number_text(count) + " values, more than the file has: it is damaged");
  return static_cast<std::size_t>(count);
}

}  // namespace catchlight::render
