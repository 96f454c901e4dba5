#include "app/media/read/picture_list.hpp"

#include <glob.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "app/media/read/sequence.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

namespace fs = std::filesystem;

struct Picture {
  std::string file;
  std::int64_t number = 0;
};

std::vector<std::string> glob_matches(const std::string& text) {
  glob_t found{};
  std::vector<std::string> files;
  if (glob(text.c_str(), 0, nullptr, &found) == 0) files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  if (files.empty()) throw Error("no file matches '" + text + "'");
  return files;
}

/// The files that a name stands for; the name itself where it is neither a glob nor a pattern.
std::vector<std::string> files_of(const std::string& name) {
  if (fs::exists(name) || name.find("://") != std::string::npos) return {name};
  if (const auto pattern = SequencePattern::parse(name)) {
    std::vector<std::string> files;
    for (const std::int64_t number : pattern->existing()) files.push_back(pattern->file(number).string());
    return files.empty() ? std::vector{name} : files;
  }
  return name.find_first_of("*?[") == std::string::npos ? std::vector{name} : glob_matches(name);
}

/// The number that ends the file's name.
std::optional<std::int64_t> number_in(const std::string& file) {
  const std::string stem = fs::path(file).stem().string();
  return integer_from_text(stem.substr(stem.find_last_not_of("0123456789") + 1));
}

std::vector<Picture> pictures_of(const std::vector<std::string>& files) {
  std::vector<Picture> pictures;
  std::set<std::int64_t> numbers;
  for (const std::string& file : files) {
    const auto number = number_in(file);
    if (number) numbers.insert(*number);
    pictures.push_back({file, number.value_or(0)});
  }
  if (numbers.size() == files.size())
    std::sort(pictures.begin(), pictures.end(), [](const Picture& a, const Picture& b) { return a.number < b.number; });
  else
    for (std::size_t i = 0; i < pictures.size(); ++i) pictures[i].number = static_cast<std::int64_t>(i);
  return pictures;
}

class PictureList final : public MediaSource {
 public:
  explicit PictureList(std::vector<Picture> pictures) : pictures_(std::move(pictures)) {
    info_ = MediaSource::open(pictures_.front().file)->info();
    info_.frame_count = static_cast<std::int64_t>(pictures_.size());
    info_.first_number = 0;
    info_.is_sequence = true;
  }

  const SourceInfo& info() const override { return info_; }
  const AVStream* video_stream() const override { return nullptr; }

  std::optional<Frame> read() override {
    if (next_ == pictures_.size()) return {};
    const Picture& picture = pictures_[next_++];
    const std::unique_ptr<MediaSource> source = MediaSource::open(picture.file);
    check_size(picture.file, source->info());
    std::optional<Frame> frame = source->read();
    if (!frame) throw DamagedMedia(picture.file + ": holds no picture");
    if (source->read()) throw Error(picture.file + ": is a video; expected one video alone, or pictures");
    return frame->numbered(picture.number);
  }

 private:
  void check_size(const std::string& file, const SourceInfo& info) const {
    if (info.width_px == info_.width_px && info.height_px == info_.height_px) return;
    const auto size = [](const SourceInfo& of) { return std::to_string(of.width_px) + "x" + std::to_string(of.height_px); };
    throw Error(file + ": is " + size(info) + ", but " + pictures_.front().file + " is " + size(info_) +
                "; expected pictures of one size");
  }

  std::vector<Picture> pictures_;
  SourceInfo info_;
  std::size_t next_ = 0;
};

bool has_gap(const std::vector<Picture>& pictures) {
  return pictures.back().number - pictures.front().number + 1 != static_cast<std::int64_t>(pictures.size());
}

}  // namespace

std::unique_ptr<MediaSource> open_footage_or_pictures(const std::vector<std::string>& names) {
  std::vector<std::string> files;
  for (const std::string& name : names)
    for (std::string& file : files_of(name)) files.push_back(std::move(file));
  const std::vector<Picture> pictures = pictures_of(files);
  const bool is_media =
      names.size() == 1 && (files.front() == names.front() || (SequencePattern::parse(names.front()) && !has_gap(pictures)));
  if (is_media) return MediaSource::open(names.front());
  return std::make_unique<PictureList>(pictures);
}

}  // namespace catchlight::app
